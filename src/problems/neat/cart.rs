//! A cart with two poles (Wieland 1991), in the equations and with the numbers of Gomez & Miikkulainen (1999).

/// Gravity, in m/s².
const GRAVITY_M_S2: f64 = -9.8;
/// The mass of the cart, in kg.
const CART_KG: f64 = 1.0;
/// The masses of the poles, in kg.
const POLES_KG: [f64; 2] = [0.1, 0.01];
/// Half the lengths of the poles, in m.
const HALF_LENGTHS_M: [f64; 2] = [0.5, 0.05];
/// The friction of the poles' hinges, in N m s.
const HINGE_FRICTION: f64 = 0.000_002;
/// The step of integration, in s.
const STEP_S: f64 = 0.01;
/// Steps of integration for each decision.
const SUBSTEPS: usize = 2;
/// The cart must not be farther from the middle than this, in m.
const TRACK_M: f64 = 2.4;
/// No pole may lean more than this, in radians: 36°.
const LEAN_MAX_RAD: f64 = 36.0 * std::f64::consts::PI / 180.0;

/// Position and speed of the cart, in m and m/s, then angle and speed of the long pole and of the short one, in radians
/// and rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cart(pub [f64; 6]);

impl Cart {
    /// Lets a force in newtons act on the cart for 0.02 s: two steps of the classical method of Runge and Kutta.
    pub fn push(&mut self, force_n: f64) {
        for _ in 0..SUBSTEPS {
            self.runge_kutta(force_n);
        }
    }

    /// Whether it is on its track and the poles stand.
    pub fn stands(&self) -> bool {
        let [x_m, _, long_rad, _, short_rad, _] = self.0;
        x_m.abs() <= TRACK_M && long_rad.abs() <= LEAN_MAX_RAD && short_rad.abs() <= LEAN_MAX_RAD
    }

    fn runge_kutta(&mut self, force_n: f64) {
        let at = |change: &[f64; 6], time_s: f64| {
            Cart(std::array::from_fn(|i| self.0[i] + time_s * change[i]))
        };
        let first = self.change(force_n);
        let second = at(&first, STEP_S / 2.0).change(force_n);
        let third = at(&second, STEP_S / 2.0).change(force_n);
        let fourth = at(&third, STEP_S).change(force_n);
        let sixth_s = STEP_S / 6.0;
        self.0 = std::array::from_fn(|i| {
            self.0[i] + sixth_s * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        });
    }

    /// What changes in a second.
    fn change(&self, force_n: f64) -> [f64; 6] {
        let [_, speed, ..] = self.0;
        let (mut force, mut mass) = (force_n, CART_KG);
        let mut hinges = [[0.0; 3]; 2];
        for (pole, hinge) in hinges.iter_mut().enumerate() {
            let [angle, turning] = [self.0[2 + 2 * pole], self.0[3 + 2 * pole]];
            let (sine, cosine) = libm::sincos(angle);
            let moment = POLES_KG[pole] * HALF_LENGTHS_M[pole];
            let friction = HINGE_FRICTION * turning / moment;
            let pull = GRAVITY_M_S2 * sine;
            let swing = moment * turning * turning * sine;
            force += swing + 0.75 * POLES_KG[pole] * cosine * (friction + pull);
            mass += POLES_KG[pole] * (1.0 - 0.75 * cosine * cosine);
            *hinge = [cosine, friction, pull];
        }
        let acceleration = force / mass;
        let [long, short] = [0, 1].map(|pole| {
            let [cosine, friction, pull] = hinges[pole];
            -0.75 * (acceleration * cosine + pull + friction) / HALF_LENGTHS_M[pole]
        });
        [speed, acceleration, self.0[3], long, self.0[5], short]
    }
}
