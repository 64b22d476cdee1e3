//! Where lanes lie.

/// The width of a lane, in metres.
const LANE_M: f32 = 3.0;
/// The height of the distances beside four lanes, in metres.
pub const DIGIT_M: f32 = 0.4;
/// The width of each of many lanes, in metres: it is more important to see them all.
const NARROW_LANE_M: f32 = 2.0;
/// So many lanes are many.
const MANY: u32 = 7;

/// Lanes side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// How many.
    pub lanes: u32,
    /// The width of each, in metres.
    pub lane_m: f32,
}

impl Track {
    /// A track of so many lanes.
    pub fn of(lanes: u32) -> Self {
        Self { lanes, lane_m: if lanes < MANY { LANE_M } else { NARROW_LANE_M } }
    }

    /// Lanes in the same place.
    pub fn shared(lanes: u32) -> Self {
        Self { lanes, lane_m: 0.0 }
    }

    /// Whether all lanes are in the same place.
    pub fn is_shared(self) -> bool {
        self.lane_m == 0.0
    }

    /// The middle of a lane: the first one is the leftmost for who looks along them.
    pub fn lane_y(self, lane: u32) -> f32 {
        -self.lane_m * lane as f32
    }

    /// The middle of all lanes.
    pub fn middle_y(self) -> f32 {
        self.lane_y(self.lanes.saturating_sub(1)) / 2.0
    }

    /// The width of all lanes, in metres.
    pub fn width_m(self) -> f32 {
        self.lane_m * self.lanes as f32
    }

    /// The height of the distances beside them, in metres.
    pub fn digit_m(self) -> f32 {
        DIGIT_M * (self.width_m() / 12.0).clamp(0.6, 1.8)
    }
}
