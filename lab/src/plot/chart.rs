//! Lines and points over two axes, each linear or logarithmic.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use super::canvas::{FONT, Figure, drawing};
use super::error::PlotError;

/// Colours that most people can tell apart (Okabe and Ito 2008), then the same again, darker.
const COLOURS: [RGBColor; 14] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
    RGBColor(0, 70, 110),
    RGBColor(130, 58, 0),
    RGBColor(0, 98, 70),
    RGBColor(126, 74, 103),
    RGBColor(141, 98, 0),
    RGBColor(52, 110, 143),
    RGBColor(0, 0, 0),
];

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// Whether it is logarithmic.
    pub log: bool,
    /// Where it starts and ends; None is what the points need.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis as long as the points need.
    pub fn linear(label: &str) -> Axis {
        Axis { label: label.into(), log: false, range: None }
    }

    /// A logarithmic axis as long as the points need. Points at or below 0 are left out.
    pub fn log(label: &str) -> Axis {
        Axis { label: label.into(), log: true, range: None }
    }

    /// From the range that is asked for, or a little more than the values take.
    fn limits(&self, values: impl Iterator<Item = f64>) -> Result<[f64; 2], PlotError> {
        let fits = |x: &f64| x.is_finite() && (!self.log || *x > 0.0);
        let [low, high] = match self.range {
            Some(range) => range,
            None => {
                let (low, high) = values
                    .filter(fits)
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
                if low > high {
                    return Err(PlotError::Empty);
                }
                let room = if high > low { 0.05 } else { 0.5 };
                if self.log {
                    let factor = (high / low).powf(room).max(1.05);
                    [low / factor, high * factor]
                } else {
                    let more = room * (high - low).max(1e-3 * high.abs()).max(1e-12);
                    [low - more, high + more]
                }
            }
        };
        if fits(&low) && fits(&high) && low < high { Ok([low, high]) } else { Err(PlotError::Axis) }
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Points joined by a line.
    Line,
    /// Points alone.
    Points,
    /// Corners of steps: the best that costs no more, as a front is read.
    Steps,
}

/// Points of one name and colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty is not in it.
    pub name: String,
    /// How it is drawn.
    pub mark: Mark,
    /// Points; those that are not finite are left out.
    pub points: Vec<[f64; 2]>,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Above it.
    pub title: String,
    /// Along the bottom.
    pub x: Axis,
    /// Up the side.
    pub y: Axis,
    /// What is drawn, at most 14, each in its own colour.
    pub series: Vec<Series>,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

impl Chart {
    /// An empty chart of 900 x 600.
    pub fn new(title: &str, x: Axis, y: Axis) -> Chart {
        Chart { title: title.into(), x, y, series: Vec::new(), size: (900, 600) }
    }

    /// The chart with one series more.
    pub fn with(mut self, name: &str, mark: Mark, points: Vec<[f64; 2]>) -> Chart {
        self.series.push(Series { name: name.into(), mark, points });
        self
    }

    fn usable(&self, points: &[[f64; 2]]) -> Vec<(f64, f64)> {
        let fits = |x: f64, axis: &Axis| x.is_finite() && (!axis.log || x > 0.0);
        points.iter().filter(|[x, y]| fits(*x, &self.x) && fits(*y, &self.y)).map(|[x, y]| (*x, *y)).collect()
    }

    fn draw_on<B, X, Y>(&self, root: &DrawingArea<B, Shift>, x: X, y: Y) -> Result<(), PlotError>
    where
        B: DrawingBackend,
        X: AsRangedCoord<Value = f64>,
        Y: AsRangedCoord<Value = f64>,
        X::CoordDescType: ValueFormatter<f64>,
        Y::CoordDescType: ValueFormatter<f64>,
    {
        let mut chart = ChartBuilder::on(root)
            .caption(&self.title, (FONT, 22))
            .margin(14)
            .x_label_area_size(48)
            .y_label_area_size(66)
            .build_cartesian_2d(x, y)
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .x_label_formatter(&|x| number(*x))
            .y_label_formatter(&|y| number(*y))
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 16))
            .light_line_style(BLACK.mix(0.05))
            .bold_line_style(BLACK.mix(0.15))
            .draw()
            .map_err(drawing)?;
        for (series, colour) in self.series.iter().zip(COLOURS) {
            let points = self.usable(&series.points);
            let line = match series.mark {
                Mark::Points => Vec::new(),
                Mark::Line => points.clone(),
                Mark::Steps => steps(&points),
            };
            chart.draw_series(LineSeries::new(line, colour.stroke_width(2))).map_err(drawing)?;
            let size = if series.mark == Mark::Points { 3 } else { 4 };
            let dots = points.iter().map(|p| Circle::new(*p, size, colour.filled()));
            let drawn = chart.draw_series(dots).map_err(drawing)?;
            if !series.name.is_empty() {
                drawn.label(&series.name).legend(move |(x, y)| Circle::new((x + 10, y), 4, colour.filled()));
            }
        }
        if self.series.iter().any(|s| !s.name.is_empty()) {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3))
                .label_font((FONT, 15))
                .draw()
                .map_err(drawing)?;
        }
        Ok(())
    }
}

impl Figure for Chart {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn draw<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), PlotError> {
        if self.series.len() > COLOURS.len() {
            return Err(PlotError::TooMuch);
        }
        let all: Vec<(f64, f64)> = self.series.iter().flat_map(|s| self.usable(&s.points)).collect();
        let [x0, x1] = self.x.limits(all.iter().map(|p| p.0))?;
        let [y0, y1] = self.y.limits(all.iter().map(|p| p.1))?;
        match (self.x.log, self.y.log) {
            (false, false) => self.draw_on(root, x0..x1, y0..y1),
            (true, false) => self.draw_on(root, (x0..x1).log_scale(), y0..y1),
            (false, true) => self.draw_on(root, x0..x1, (y0..y1).log_scale()),
            (true, true) => self.draw_on(root, (x0..x1).log_scale(), (y0..y1).log_scale()),
        }
    }
}

/// The line that keeps a height until the next point is reached.
fn steps(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut line = Vec::with_capacity(2 * points.len());
    for (i, p) in points.iter().enumerate() {
        if let Some(before) = i.checked_sub(1).and_then(|i| points.get(i)) {
            line.push((p.0, before.1));
        }
        line.push(*p);
    }
    line
}

/// A number as short as an axis wants it.
fn number(x: f64) -> String {
    let size = x.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        format!("{x:.0e}")
    } else {
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        Chart::new("cost and error", Axis::log("ms"), Axis::log("%")).with("uniform", Mark::Steps, points)
    }

    #[test]
    fn a_chart_is_a_picture_of_its_size_and_the_same_every_time() {
        let c = chart(vec![[1.0, 30.0], [10.0, 3.0], [0.0, 1.0], [f64::NAN, 2.0]]);
        let png = c.png().unwrap();
        let picture = image::load_from_memory(&png).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (900, 600));
        let blue = picture.pixels().filter(|p| p.0 == [0, 114, 178]).count();
        assert!(blue > 500, "{blue} pixels of the line");
        assert_eq!(png, c.png().unwrap());
        let svg = c.svg().unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("cost and error") && svg.contains("uniform"));
    }

    #[test]
    fn what_cannot_be_drawn_is_an_error() {
        assert_eq!(chart(vec![]).png(), Err(PlotError::Empty));
        assert_eq!(chart(vec![[-1.0, 1.0]]).png(), Err(PlotError::Empty));
        assert!(chart(vec![[1.0, 1.0]]).png().is_ok());
        let mut c = chart(vec![[1.0, 1.0]]);
        c.x.range = Some([2.0, 1.0]);
        assert_eq!(c.png(), Err(PlotError::Axis));
        c.size = (0, 10);
        assert_eq!(c.png(), Err(PlotError::TooMuch));
        let many = (0..15).fold(chart(vec![[1.0, 2.0]]), |c, _| c.with("", Mark::Points, vec![]));
        assert_eq!(many.png(), Err(PlotError::TooMuch));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.001, 0.25, 10.0, 1e6, 0.0].map(number), ["0.001", "0.25", "10", "1e6", "0"]);
    }
}
