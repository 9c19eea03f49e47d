//! The learning curve as a picture.

use std::fs;
use std::path::Path;

use plotters::prelude::*;

use crate::run::{Line, TrainError, file_error};
use crate::whole;

const SIZE: (u32, u32) = (900, 640);
const TEXT: (&str, u32) = ("sans-serif", 14);

/// A name, its points, its colour.
type Curve<'a> = (&'a str, Vec<(f64, f64)>, RGBColor);
type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

/// Draws the log of a run, `log.jsonl`, as its `curve.svg`.
///
/// # Errors
/// [`TrainError::File`].
pub fn draw_log(run: &Path) -> Result<(), TrainError> {
    let path = run.join("log.jsonl");
    let text = fs::read_to_string(&path).map_err(|cause| file_error(&path, cause))?;
    // A line that a kill cut, or that holds no number, is not drawn.
    let lines: Vec<Line> = text
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    let path = run.join("curve.svg");
    whole::write(&path, curve(&lines).as_bytes()).map_err(|cause| file_error(&path, cause))
}

/// Draws the lines of a log as SVG: loss and held-back distortion above, held-back folds below.
fn curve(lines: &[Line]) -> String {
    let mut svg = String::new();
    draw(lines, &mut svg).expect("a picture in memory can be drawn");
    svg
}

fn draw<'a>(lines: &[Line], svg: &'a mut String) -> Drawn<'a> {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (above, below) = root.split_vertically((SIZE.1 * 3 / 5) as i32);
    let of = |value: fn(&Line) -> f64| -> Vec<(f64, f64)> {
        let points = lines.iter().map(|line| (line.step as f64, value(line)));
        points.filter(|point| point.1.is_finite()).collect()
    };
    let distortion = [
        (
            "loss, training",
            of(|line| line.loss),
            RGBColor(200, 90, 30),
        ),
        (
            "distortion, held back",
            of(|line| line.held_out.energy),
            RGBColor(30, 90, 180),
        ),
    ];
    // Names stand where the curves are not: distortion never comes near zero, folds start high.
    let what = "mean log form of the distortion";
    panel(&above, what, &distortion, SeriesLabelPosition::LowerLeft)?;
    let folds = of(|line| line.held_out.folds_pct);
    panel(
        &below,
        "folded triangles, %",
        &[("folds, held back", folds, RGBColor(30, 90, 180))],
        SeriesLabelPosition::UpperRight,
    )?;
    root.present()
}

fn panel<'a>(
    area: &Area<'a>,
    what: &str,
    curves: &[Curve<'_>],
    legend: SeriesLabelPosition,
) -> Drawn<'a> {
    let points = || curves.iter().flat_map(|(_, points, _)| points);
    let last = points().map(|p| p.0).fold(1.0, f64::max);
    let most = points().map(|p| p.1).fold(f64::MIN_POSITIVE, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(34)
        .y_label_area_size(54)
        .build_cartesian_2d(0.0..last, 0.0..1.05 * most)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("steps").y_desc(what).label_style(TEXT);
    mesh.max_light_lines(1);
    mesh.x_label_formatter(&|x| format!("{x:.0}")).draw()?;
    for (name, points, colour) in curves {
        let line = LineSeries::new(points.iter().copied(), colour.stroke_width(2));
        let drawn = chart.draw_series(line)?.label(*name);
        let colour = *colour;
        drawn.legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
    }
    let mut labels = chart.configure_series_labels();
    labels
        .label_font(TEXT)
        .position(legend)
        .background_style(WHITE)
        .border_style(BLACK);
    labels.draw()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Figures;

    #[test]
    fn every_curve_is_drawn_with_its_name() {
        let line = |step: usize| Line {
            step,
            loss: 3.0 / step as f64,
            rate: 1e-3,
            held_out: Figures::default(),
        };
        let svg = curve(&[line(500), line(1000), line(1500)]);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        let n_lines = svg.matches("stroke-width=\"2\"").count();
        assert_eq!(n_lines, 3, "{svg}");
        for name in [
            "loss, training",
            "distortion, held back",
            "folds, held back",
        ] {
            assert!(svg.contains(name), "{name}");
        }
    }

    #[test]
    fn a_run_without_lines_and_one_of_nans_have_a_picture() {
        let nan = Line {
            step: 1,
            loss: f64::NAN,
            rate: f64::INFINITY,
            held_out: Figures::default(),
        };
        for lines in [&[][..], &[nan]] {
            assert!(curve(lines).contains("</svg>"));
        }
    }
}
