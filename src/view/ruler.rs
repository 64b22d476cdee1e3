//! Distances painted on the ground.

use rerun::{Color, LineStrips3D};

/// A line across a lane at each metre, with its number beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ruler {
    /// How many metres from the start, which has a line too.
    pub metres: u32,
    /// Where lines begin, across the lane, in metres.
    pub left_m: f32,
    /// Where they end and the numbers stand.
    pub right_m: f32,
    /// The height of a digit, in metres.
    pub digit_m: f32,
    /// Half the thickness of lines, in metres.
    pub line_m: f32,
    /// Of so many lines one has a number.
    pub every: u32,
}

/// Above the floor, so that the two do not flicker.
const HEIGHT_M: f32 = 0.006;
/// The width of a digit and the step to the next one, in heights.
const DIGIT: [f32; 2] = [0.55, 0.8];

impl Ruler {
    /// The ruler as lines.
    pub fn paint(&self, color: Color) -> LineStrips3D {
        let (mut strips, mut radii) = (Vec::new(), Vec::new());
        for metre in 0..=self.metres {
            let x = metre as f32;
            strips.push(vec![[x, self.left_m, HEIGHT_M], [x, self.right_m, HEIGHT_M]]);
            radii.push(if metre == 0 { 3.0 * self.line_m } else { self.line_m });
            if metre.is_multiple_of(self.every) {
                self.write(&format!("{metre}m"), x, &mut strips);
            }
            radii.resize(strips.len(), 1.3 * self.line_m);
        }
        LineStrips3D::new(strips).with_radii(radii).with_colors([color])
    }

    /// Writes a word whose foot is farthest from the line, to be read by who looks across the lane from its right.
    fn write(&self, word: &str, x: f32, strips: &mut Vec<Vec<[f32; 3]>>) {
        let [width, step] = DIGIT.map(|share| share * self.digit_m);
        let length = step * word.len() as f32 - (step - width);
        let foot = self.right_m - 1.35 * self.digit_m;
        for (place, letter) in word.chars().enumerate() {
            let left = x - length / 2.0 + step * place as f32;
            strips.extend(strokes(letter).iter().map(|stroke| {
                let point =
                    |&[u, v]: &[f32; 2]| [left + u * width, foot + v * self.digit_m, HEIGHT_M];
                stroke.iter().map(point).collect()
            }));
        }
    }
}

/// The strokes of a digit, as on a pocket calculator, or of the unit, in a box from 0 to 1.
fn strokes(letter: char) -> &'static [&'static [[f32; 2]]] {
    match letter {
        '0' => &[&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]],
        '1' => &[&[[0.2, 0.8], [0.6, 1.0], [0.6, 0.0]]],
        '2' => &[&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.5], [0.0, 0.5], [0.0, 0.0], [1.0, 0.0]]],
        '3' => &[&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], &[[0.2, 0.5], [1.0, 0.5]]],
        '4' => &[&[[0.0, 1.0], [0.0, 0.5], [1.0, 0.5]], &[[1.0, 1.0], [1.0, 0.0]]],
        '5' => &[&[[1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5], [1.0, 0.0], [0.0, 0.0]]],
        '6' => &[&[[1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]]],
        '7' => &[&[[0.0, 1.0], [1.0, 1.0], [0.4, 0.0]]],
        '8' => &[
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]],
            &[[0.0, 0.5], [1.0, 0.5]],
        ],
        '9' => &[&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.5]]],
        // The unit, smaller.
        _ => &[&[[0.1, 0.0], [0.1, 0.5], [0.9, 0.5], [0.9, 0.0]], &[[0.5, 0.5], [0.5, 0.0]]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_digit_looks_different() {
        let looks: std::collections::BTreeSet<String> =
            ('0'..='9').chain(['m']).map(|digit| format!("{:?}", strokes(digit))).collect();
        assert_eq!(looks.len(), 11);
    }
}
