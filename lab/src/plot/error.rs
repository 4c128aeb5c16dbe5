use std::fmt;

/// Why a plot cannot be drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum PlotError {
    /// Nothing finite (and above 0 on a logarithmic axis) to draw.
    Empty,
    /// An axis whose end is not above its start, not finite, or not above 0 where it is logarithmic; cells that do not fit
    /// their axes or the legend.
    Axis,
    /// More series than colours, or a picture that is too large.
    TooMuch,
    /// The drawing library refused.
    Drawing(String),
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlotError::Empty => f.write_str("nothing to plot"),
            PlotError::Axis => f.write_str("an axis of the plot has no length, or not that of its cells"),
            PlotError::TooMuch => f.write_str("too much for one plot"),
            PlotError::Drawing(text) => write!(f, "cannot draw the plot: {text}"),
        }
    }
}

impl std::error::Error for PlotError {}
