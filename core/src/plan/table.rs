//! Written by the lab's example `distill` from lab/data/plan.csv: do not edit.

use super::{FabricLaw, Price, Row, StepLaw};

/// A row for each hold, in the order of their numbers.
#[rustfmt::skip]
pub(super) const ROWS: [Row; 5] = [
    // Edge
    Row {
        plain: StepLaw { constant: -0.419, grid: 2.220, step: 0.969, margin: 0.039 },
        inertia: StepLaw { constant: 0.033, grid: 1.950, step: 0.974, margin: 0.029 },
        tethers: StepLaw { constant: -4.833, grid: 1.088, step: 0.552, margin: 0.546 },
        fabric: FabricLaw { constant: -0.413, grid: 0.097, warp: 0.985, weft: 0.017, shear: -0.003, margin: 0.095 },
        plain_price: Price { constant: 0.55, grid: 5.53, step: 0.75 },
        tethers_price: Price { constant: 5.36, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 73.78, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 94.51, grid: 1738.09, step: 0.00 },
    },
    // Hooks
    Row {
        plain: StepLaw { constant: 0.058, grid: 2.379, step: 0.892, margin: 0.473 },
        inertia: StepLaw { constant: -1.215, grid: 1.771, step: 0.674, margin: 0.641 },
        tethers: StepLaw { constant: -1.828, grid: 1.724, step: 0.629, margin: 0.257 },
        fabric: FabricLaw { constant: -2.779, grid: 1.317, warp: 0.468, weft: -0.040, shear: 0.573, margin: 0.568 },
        plain_price: Price { constant: 0.57, grid: 3.18, step: 0.59 },
        tethers_price: Price { constant: 3.86, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 146.30, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 90.77, grid: 1787.55, step: 0.00 },
    },
    // Corners
    Row {
        plain: StepLaw { constant: -0.417, grid: 2.778, step: 0.960, margin: 0.042 },
        inertia: StepLaw { constant: 0.683, grid: 1.832, step: 0.916, margin: 0.063 },
        tethers: StepLaw { constant: -0.525, grid: 1.354, step: 0.811, margin: 0.160 },
        fabric: FabricLaw { constant: -1.189, grid: 0.994, warp: 0.344, weft: 0.579, shear: 0.077, margin: 0.127 },
        plain_price: Price { constant: 0.56, grid: 2.50, step: 0.52 },
        tethers_price: Price { constant: 5.40, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 133.42, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 93.82, grid: 1635.27, step: 0.00 },
    },
    // Corner
    Row {
        plain: StepLaw { constant: -0.502, grid: 2.442, step: 0.824, margin: 0.226 },
        inertia: StepLaw { constant: 0.213, grid: 1.380, step: 0.687, margin: 0.207 },
        tethers: StepLaw { constant: -0.800, grid: 0.429, step: 0.327, margin: 0.286 },
        fabric: FabricLaw { constant: -0.367, grid: 0.860, warp: 0.081, weft: 0.867, shear: 0.052, margin: 0.155 },
        plain_price: Price { constant: 0.88, grid: 4.54, step: 0.60 },
        tethers_price: Price { constant: 4.61, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 306.13, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 104.81, grid: 3146.17, step: 0.00 },
    },
    // Loose
    Row {
        plain: StepLaw { constant: -1.452, grid: 1.079, step: 0.463, margin: 0.284 },
        inertia: StepLaw { constant: 0.000, grid: 0.000, step: 0.000, margin: 0.000 },
        tethers: StepLaw { constant: 0.000, grid: 0.000, step: 0.000, margin: 0.000 },
        fabric: FabricLaw { constant: 1.218, grid: 0.415, warp: 0.594, weft: -0.357, shear: 0.764, margin: 0.369 },
        plain_price: Price { constant: 1.00, grid: 0.00, step: 0.00 },
        tethers_price: Price { constant: 0.00, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 140.13, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 121.00, grid: 3734.52, step: 0.00 },
    },
];
