//! Written by the lab's example `distill` from lab/data/plan.csv: do not edit.

use super::strains::Strains;
use super::{FabricLaw, Price, Row};

/// A row for each hold, in the order of their numbers.
#[rustfmt::skip]
pub(super) const ROWS: [Row; 5] = [
    // Edge
    Row {
        plain: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-2.775, -4.126, -4.931, -5.504, -6.312, -6.884, -8.263], &[-1.264, -2.516, -3.304, -3.863, -4.669, -5.242, -6.611], &[-0.090, -1.063, -1.762, -2.285, -3.068, -3.624, -4.987]], margin: 0.076 },
        inertia: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-3.111, -4.476, -5.287, -5.852, -6.659, -7.222, -8.522], &[-1.756, -3.055, -3.843, -4.415, -5.215, -5.780, -7.106], &[-0.201, -1.734, -2.479, -3.030, -3.814, -4.379, -5.749]], margin: 0.030 },
        tethers: Strains { substeps: &[2.0, 4.0, 8.0, 16.0], ln_strain: [&[-5.884, -7.220, -8.413, -9.884], &[-4.992, -6.058, -7.319, -8.408], &[-4.565, -4.565, -6.061, -7.407]], margin: 0.403 },
        whole: FabricLaw { constant: -0.495, grid: 0.134, warp: 0.989, weft: 0.032, shear: -0.021, margin: 0.062 },
        implicit: FabricLaw { constant: -0.434, grid: 0.115, warp: 0.989, weft: 0.038, shear: -0.027, margin: 0.066 },
        plain_price: Price { constant: 0.49, grid: 7.88, step: 0.80 },
        tethers_price: Price { constant: 1.71, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 13.25, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 67.50, grid: 1295.12, step: 0.00 },
    },
    // Hooks
    Row {
        plain: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-1.151, -2.269, -3.238, -3.753, -4.679, -5.501, -5.710], &[0.061, -0.879, -1.430, -1.847, -2.691, -3.161, -4.477], &[1.096, 0.354, -0.100, -0.598, -1.202, -1.617, -2.622]], margin: 0.188 },
        inertia: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-1.868, -3.185, -3.947, -4.582, -4.879, -4.879, -5.365], &[-0.833, -1.788, -2.338, -2.729, -3.639, -3.887, -4.787], &[0.508, -0.721, -1.318, -1.603, -2.069, -2.495, -3.444]], margin: 0.214 },
        tethers: Strains { substeps: &[2.0, 4.0, 8.0, 16.0], ln_strain: [&[-1.735, -2.537, -3.510, -4.525], &[-0.557, -1.483, -1.982, -3.074], &[0.503, -0.102, -1.219, -1.777]], margin: 0.185 },
        whole: FabricLaw { constant: -0.089, grid: 0.641, warp: 0.548, weft: 0.345, shear: 0.107, margin: 0.461 },
        implicit: FabricLaw { constant: -2.779, grid: 1.317, warp: 0.468, weft: -0.040, shear: 0.573, margin: 0.568 },
        plain_price: Price { constant: 0.60, grid: 3.30, step: 0.94 },
        tethers_price: Price { constant: 2.51, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 39.45, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 78.17, grid: 1083.62, step: 0.00 },
    },
    // Corners
    Row {
        plain: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-1.269, -2.510, -3.288, -3.856, -4.641, -5.225, -6.608], &[0.545, -0.658, -1.359, -1.878, -2.623, -3.174, -4.529], &[2.284, 1.205, 0.455, -0.048, -0.756, -1.255, -2.521]], margin: 0.030 },
        inertia: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-2.250, -3.510, -4.280, -4.840, -5.636, -6.203, -7.575], &[-1.071, -2.216, -2.938, -3.468, -4.234, -4.789, -6.122], &[0.086, -1.067, -1.707, -2.196, -2.909, -3.436, -4.711]], margin: 0.030 },
        tethers: Strains { substeps: &[2.0, 4.0, 8.0, 16.0], ln_strain: [&[-2.616, -3.802, -5.113, -6.477], &[-1.804, -2.780, -3.898, -5.124], &[-1.111, -2.067, -3.014, -4.052]], margin: 0.077 },
        whole: FabricLaw { constant: -1.193, grid: 0.994, warp: 0.341, weft: 0.581, shear: 0.078, margin: 0.130 },
        implicit: FabricLaw { constant: -1.189, grid: 0.994, warp: 0.344, weft: 0.579, shear: 0.077, margin: 0.127 },
        plain_price: Price { constant: 0.62, grid: 1.69, step: 0.50 },
        tethers_price: Price { constant: 1.39, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 25.75, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 72.77, grid: 1169.53, step: 0.00 },
    },
    // Corner
    Row {
        plain: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-0.908, -2.152, -2.877, -3.385, -4.102, -4.563, -5.389], &[1.096, -0.235, -0.991, -1.504, -2.223, -2.728, -3.933], &[2.899, 1.767, 1.005, 0.429, -0.339, -0.869, -2.124]], margin: 0.030 },
        inertia: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-1.903, -3.016, -3.578, -3.954, -4.494, -4.893, -5.847], &[-0.662, -1.877, -2.532, -2.952, -3.457, -3.796, -4.606], &[0.423, -0.707, -1.427, -1.972, -2.689, -2.897, -3.832]], margin: 0.111 },
        tethers: Strains { substeps: &[2.0, 4.0, 8.0, 16.0], ln_strain: [&[-2.037, -2.298, -2.944, -3.743], &[-1.725, -2.167, -2.466, -2.787], &[-1.413, -1.982, -2.466, -2.701]], margin: 0.215 },
        whole: FabricLaw { constant: -0.510, grid: 0.914, warp: 0.065, weft: 0.899, shear: 0.036, margin: 0.106 },
        implicit: FabricLaw { constant: -0.511, grid: 0.923, warp: 0.072, weft: 0.894, shear: 0.034, margin: 0.116 },
        plain_price: Price { constant: 0.85, grid: 4.60, step: 0.54 },
        tethers_price: Price { constant: 1.45, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 39.52, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 57.13, grid: 1332.05, step: 0.00 },
    },
    // Loose
    Row {
        plain: Strains { substeps: &[4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0], ln_strain: [&[-2.341, -3.397, -3.448, -3.665, -4.272, -4.437, -5.362], &[-1.823, -2.498, -2.902, -3.129, -3.519, -3.633, -4.054], &[-0.961, -1.841, -2.339, -2.560, -2.888, -3.070, -3.671]], margin: 0.226 },
        inertia: Strains { substeps: &[], ln_strain: [&[], &[], &[]], margin: 0.030 },
        tethers: Strains { substeps: &[], ln_strain: [&[], &[], &[]], margin: 0.030 },
        whole: FabricLaw { constant: 1.278, grid: -0.154, warp: 0.237, weft: 0.585, shear: 0.178, margin: 0.399 },
        implicit: FabricLaw { constant: 4.069, grid: -0.428, warp: 0.436, weft: 0.033, shear: 0.531, margin: 1.437 },
        plain_price: Price { constant: 1.00, grid: 0.00, step: 0.00 },
        tethers_price: Price { constant: 0.00, grid: 0.00, step: 0.00 },
        levels_price: Price { constant: 38.61, grid: 0.00, step: 0.00 },
        implicit_price: Price { constant: 71.01, grid: 1939.04, step: 0.00 },
    },
];
