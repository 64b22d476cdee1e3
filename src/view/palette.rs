//! Every colour, chosen for a dark background.

use rerun::Color;

/// What is behind everything: nearly black, a little blue.
pub const BACKDROP: [u8; 3] = [14, 17, 24];

/// The start line, the distance marks, and bodies that are no island's.
pub const MARKS: [u8; 3] = [170, 176, 188];

/// Where a foot is on the ground.
pub const TOUCH: [u8; 3] = [250, 250, 245];

/// The Okabe-Ito palette, which colour-blind people can tell apart, with its dark colours lifted and its
/// black left out; in an order that keeps neighbours far apart.
/// Source: M. Okabe, K. Ito, "Color Universal Design" (2008).
const HUES: [[u8; 3]; 8] = [
    [86, 180, 233],
    [240, 165, 20],
    [30, 190, 140],
    [226, 128, 184],
    [240, 228, 66],
    [235, 105, 45],
    [90, 125, 245],
    [190, 194, 204],
];

/// The colour of an island. From the ninth island on, the hues come again, each time darker.
pub fn island(island: u32) -> [u8; 3] {
    let round = island as usize / HUES.len();
    mix(HUES[island as usize % HUES.len()], BACKDROP, (0.3 * round as f32).min(0.6))
}

/// The colour of a link of an island's creature: neighbouring links differ in lightness.
pub fn link(island: u32, link: usize) -> Color {
    shaded(self::island(island), link)
}

/// The colour of a link of who or what is in a creature's world, and no island's.
pub fn other(link: usize) -> Color {
    shaded(MARKS, link)
}

fn shaded(hue: [u8; 3], link: usize) -> Color {
    // The trunk is link 0: the brightest.
    let darkness = [0.0, 0.34, 0.17, 0.42, 0.25][link % 5];
    opaque(mix(hue, BACKDROP, darkness))
}

/// The two colours of an island's checkered floor.
pub fn floor(island: u32) -> [[u8; 3]; 2] {
    let hue = self::island(island);
    [mix(hue, BACKDROP, 0.88), mix(hue, BACKDROP, 0.77)]
}

/// What is painted on an island's floor.
pub fn paint(island: u32) -> Color {
    opaque(mix(self::island(island), BACKDROP, 0.45))
}

/// A motor that drives one way (1), not at all (0) or the other way (-1): light, grey, dark, which everybody can
/// tell apart and which no island has.
pub fn drive(way: f32) -> Color {
    opaque(mix([18, 18, 22], [255, 255, 250], (way + 1.0) / 2.0))
}

/// `from` and `to` mixed, `part` of it `to`.
pub fn mix(from: [u8; 3], to: [u8; 3], part: f32) -> [u8; 3] {
    std::array::from_fn(|i| {
        let (from, to) = (f32::from(from[i]), f32::from(to[i]));
        (from + (to - from) * part.clamp(0.0, 1.0)).round() as u8
    })
}

/// As a Rerun colour.
pub fn opaque([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgb(r, g, b)
}
