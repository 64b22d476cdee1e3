//! Curves with bands as an SVG picture, such as how several settings converge.

use plotters::coord::Shift;
use plotters::prelude::*;

/// The colours of Okabe & Ito (2008), which people of any colour vision tell apart, but for yellow, which is pale on
/// white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x00, 0x00),
];

const FONT: &str = "sans-serif";
/// Size of the picture, and of its legend at the right, in pixels; it is higher if the legend is.
const SIZE: (u32, u32) = (1040, 520);
const LEGEND: u32 = 330;
const LINE: u32 = 22;
/// No more of a name is shown, in characters: the legend is not wider.
const NAME_MAX: usize = 38;
/// How opaque a band is, and where there are more curves than four.
const OPACITY: [f64; 2] = [0.16, 0.07];

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What runs along the horizontal axis, with its unit.
    pub x: String,
    /// What runs along the vertical axis, with its unit.
    pub y: String,
    /// Whether the vertical axis is logarithmic: then all values are above 0.
    pub is_logarithmic: bool,
    /// What is drawn, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// A curve and the band around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Its points, `x` ascending; all numbers are finite.
    pub points: Vec<Point>,
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where it is.
    pub x: f64,
    /// The lower end of the band.
    pub low: f64,
    /// The curve.
    pub middle: f64,
    /// The upper end of the band.
    pub high: f64,
}

impl Chart {
    /// Draws it. The text is set in whatever font the reader has.
    pub fn to_svg(&self) -> String {
        let mut svg = String::new();
        self.draw(&mut svg).expect("there is room in a string for any picture");
        svg
    }

    fn draw(&self, svg: &mut String) -> Result<(), Box<dyn std::error::Error + '_>> {
        let height = SIZE.1.max(LINE * (self.curves.len() as u32 + 2));
        let root = SVGBackend::with_string(svg, (SIZE.0, height)).into_drawing_area();
        root.fill(&WHITE).map_err(text)?;
        let (plot, legend) = root.split_horizontally(SIZE.0 - LEGEND);
        self.draw_curves(&plot)?;
        self.draw_legend(&legend)?;
        root.present().map_err(text)?;
        Ok(())
    }

    fn draw_curves(&self, area: &Area<'_>) -> Result<(), String> {
        let (x, y) = self.ranges();
        let mut builder = ChartBuilder::on(area);
        builder.margin(14).x_label_area_size(48).y_label_area_size(76);
        let mut chart = builder.build_cartesian_2d(x, y).map_err(text)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(self.x.as_str())
            .y_desc(self.y.as_str())
            .x_labels(8)
            .y_labels(8)
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| self.label(*y))
            .axis_desc_style((FONT, 18))
            .label_style((FONT, 15))
            .draw()
            .map_err(text)?;
        let opacity = OPACITY[usize::from(self.curves.len() > 4)];
        for (index, curve) in self.curves.iter().enumerate() {
            let at = |value: f64| self.place(value);
            let lower = curve.points.iter().map(|point| (point.x, at(point.low)));
            let upper = curve.points.iter().rev().map(|point| (point.x, at(point.high)));
            let band: Vec<_> = lower.chain(upper).collect();
            chart.draw_series([Polygon::new(band, colour(index).mix(opacity))]).map_err(text)?;
        }
        for (index, curve) in self.curves.iter().enumerate() {
            let points = curve.points.iter().map(|point| (point.x, self.place(point.middle)));
            let style = colour(index).stroke_width(2);
            match is_dashed(index) {
                true => chart.draw_series(DashedLineSeries::new(points, 7, 5, style)),
                false => chart.draw_series(LineSeries::new(points, style)),
            }
            .map_err(text)?;
        }
        Ok(())
    }

    fn draw_legend(&self, area: &Area<'_>) -> Result<(), String> {
        let places = (30..).step_by(LINE as usize);
        for ((index, curve), y) in self.curves.iter().enumerate().zip(places) {
            let style = colour(index).stroke_width(3);
            let ends: &[(i32, i32)] = match is_dashed(index) {
                true => &[(4, 12), (18, 26)],
                false => &[(4, 26)],
            };
            for &(from, to) in ends {
                let line = PathElement::new(vec![(from, y), (to, y)], style);
                area.draw(&line).map_err(text)?;
            }
            let name = Text::new(shortened(&curve.name), (34, y - 7), (FONT, 16));
            area.draw(&name).map_err(text)?;
        }
        Ok(())
    }

    /// Where a value is on the vertical axis, which is linear for the one who draws.
    fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic { libm::log10(value) } else { value }
    }

    /// The number that stands at a place of the vertical axis.
    fn label(&self, place: f64) -> String {
        let rounded = (place * 1e9).round() / 1e9;
        match self.is_logarithmic {
            true if rounded.fract() == 0.0 => format!("1e{rounded}"),
            true => format!("{:.1e}", libm::exp10(place)),
            false => format!("{rounded}"),
        }
    }

    fn ranges(&self) -> (std::ops::Range<f64>, std::ops::Range<f64>) {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let x = points().map(|point| point.x).fold(0.0, f64::max);
        let low = points().map(|point| self.place(point.low)).reduce(f64::min).unwrap_or(0.0);
        let high = points().map(|point| self.place(point.high)).reduce(f64::max).unwrap_or(1.0);
        // Where nothing ever changes there is an axis all the same.
        let margin = ((high - low) * 0.04).max(high.abs() * 1e-3).max(1e-9);
        (0.0..x.max(1.0) * 1.01, low - margin..high + margin)
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn colour(index: usize) -> RGBColor {
    COLOURS[index % COLOURS.len()]
}

/// Where the colours begin anew, so does the way in which lines are drawn.
fn is_dashed(index: usize) -> bool {
    (index / COLOURS.len()) % 2 == 1
}

/// Names that are made of settings differ at their ends as well as at their beginnings.
fn shortened(name: &str) -> String {
    let length = name.chars().count();
    if length <= NAME_MAX {
        return name.to_owned();
    }
    let half = NAME_MAX / 2;
    let (first, last) = (name.chars().take(half), name.chars().skip(length + 1 - half));
    first.chain(['…']).chain(last).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(is_logarithmic: bool, curves: usize) -> Chart {
        let point = |x: u32| {
            let middle = 1.0 / f64::from(x);
            Point { x: f64::from(x), low: middle / 2.0, middle, high: middle * 2.0 }
        };
        let curve =
            |index| Curve { name: format!("a < {index}"), points: (1..9).map(point).collect() };
        let curves = (0..curves).map(curve).collect();
        Chart { x: "tries".to_owned(), y: "loss (m)".to_owned(), is_logarithmic, curves }
    }

    #[test]
    fn a_picture_is_well_formed_and_has_a_band_a_line_and_a_name_for_each_curve() {
        let svg = chart(false, 3).to_svg();
        let tree = roxmltree::Document::parse(&svg).expect("it is XML");
        let count = |tag: &str| tree.descendants().filter(|it| it.has_tag_name(tag)).count();
        assert_eq!(count("polygon"), 3);
        // The axes are polylines too.
        let coloured = |node: &roxmltree::Node<'_, '_>| {
            let stroke = node.attribute("stroke");
            (0..3).any(|index| {
                let RGBColor(r, g, b) = colour(index);
                stroke == Some(&format!("#{r:02X}{g:02X}{b:02X}"))
            })
        };
        let lines = tree.descendants().filter(|it| it.has_tag_name("polyline") && coloured(it));
        assert_eq!(lines.count(), 6, "a line and its sample in the legend");
        let texts: Vec<_> = tree.descendants().filter_map(|it| it.text()).map(str::trim).collect();
        for expected in ["tries", "loss (m)", "a < 0", "a < 2"] {
            assert!(texts.contains(&expected), "{expected} in {texts:?}");
        }
    }

    #[test]
    fn a_logarithmic_axis_is_labelled_with_what_was_measured() {
        let chart = chart(true, 1);
        assert_eq!(chart.label(-2.0), "1e-2");
        assert_eq!(chart.label(-1.5), "3.2e-2");
        assert!(chart.to_svg().contains("1e-1\n"), "{}", chart.to_svg());
    }

    #[test]
    fn a_long_name_keeps_both_its_ends() {
        let name: String = ('a'..='z').chain('A'..='Z').collect();
        let shown = shortened(&name);
        assert_eq!(shown.chars().count(), NAME_MAX);
        assert!(shown.starts_with("abcdefghijklmnopqrs…") && shown.ends_with("XYZ"), "{shown}");
        assert_eq!(shortened(&shown), shown);
    }

    #[test]
    fn what_is_flat_empty_or_many_can_be_drawn() {
        let empty = Chart { curves: Vec::new(), ..chart(false, 0) };
        assert!(empty.to_svg().ends_with("</svg>\n"));
        let mut flat = chart(true, 1);
        for point in &mut flat.curves[0].points {
            (point.low, point.middle, point.high) = (1.0, 1.0, 1.0);
        }
        let (_, heights) = flat.ranges();
        assert!(heights.start < heights.end && !flat.to_svg().contains("NaN"), "{heights:?}");
        let many = chart(false, 20).to_svg();
        assert_eq!(many.matches("<polygon").count(), 20);
    }
}
