//! Our own stepper, for what creatures are: a tree of hinges on the ground, without contacts among its links.
//!
//! All dynamics are in reduced coordinates, by recursions over articulated bodies (R. Featherstone, *Rigid Body
//! Dynamics Algorithms*, Springer 2008; numbers of chapters, sections and equations here are this book's), in double
//! precision. From where the body is to where it is one step later:
//!
//! - [`contact`] finds the points that may touch the ground, on a terrain [`relief`];
//! - [`factor`] takes the mass matrix apart and turns momenta into velocities, as if nothing held the body;
//! - [`constraint`] and [`solver`] find the impulses of motors and contacts, which change them;
//! - [`kinematics`] moves the body by them. [`model`] is what stays the same, [`spatial`] the algebra.
//!
//! # How time is stepped
//!
//! What goes over from one step to the next is not velocity but each link's momentum, in the world's axes: it stays
//! unless something pushes, so that no Coriolis or gyroscopic force has to be computed, and all links' momentum
//! together is kept to the last digits. The next velocities are those of the body that have this momentum along
//! every direction in which it can move: sᵀ Σ(h⁺ − h − impulses) = 0 for each axis s, d'Alembert's principle over
//! a step. As in leapfrog, velocities belong to the middle of the way between two configurations, and are evaluated
//! there: half a step ahead of where the body is. The axes of that equation belong between two such middles;
//! `FeatherstoneWorld::swing` makes up for that half a step. An undriven chain keeps its energy to 1 in 1,000 over
//! ten seconds this way; with axes or places that are off by half a step some gain a third or lose a tenth.
//!
//! Forces act between two such middles, too, which is where the body is when a step begins: weights at the links'
//! centres (`FeatherstoneWorld::fall`), the ground at the points that it touches (`Touch::acts_m`). Both
//! must: a weight half a step ahead damps what swings, a ground half a step ahead of the weight brakes what rolls. The
//! lowest point of what is round goes along with its centre, and a corner that sticks stays where it is.
//!
//! # Motors that hold
//!
//! Most motors are strong enough at most moments. Their hinges then turn exactly as they should, and need neither a
//! degree of freedom nor a constraint: they are held, and what they transmit is checked afterwards. A motor that
//! would have had to give more than it can lets go, the step is solved again with its hinge loose, and it takes hold
//! again when it is at ease.
//!
//! # Several worlds at a time
//!
//! A world here is several side by side ([`lanes`](super::lanes)), as many as a [`Width`](super::lanes::width::Width)
//! has, all with the same body: the trials of a body differ in their numbers alone. Where they part (a contact that
//! one of them has, a hinge that is loose in some) all do what any of them needs, and keep it to those that need it.
//! That is what eight at a time lose: eight random trials of a body have 2.4 times as many points in contact as one of
//! them, and sweep twice as often.

mod constraint;
mod contact;
mod factor;
mod kinematics;
mod lane;
mod model;
mod relief;
mod separate;
mod solver;
mod spatial;
mod step;
#[cfg(test)]
mod tests;
mod worlds;

pub use contact::{Footing, Plane};
pub use relief::Relief;
pub use separate::Separate;
pub use worlds::FeatherstoneWorld;
