use super::{FabricLaw, Prices, Row, StepLaw};
const LAW: StepLaw = StepLaw { constant: 0.0, grid: 0.0, step: 0.0, margin: 0.0 };
const FABRIC: FabricLaw = FabricLaw { constant: 0.0, grid: 0.0, warp: 0.0, weft: 0.0, shear: 0.0, margin: 0.0 };
const PRICES: Prices = Prices { plain: 1.0, tethers: 0.0, levels: 0.0, implicit: 0.0 };
const ROW: Row = Row { plain: LAW, inertia: LAW, tethers: LAW, fabric: FABRIC, prices: PRICES };
pub(super) const ROWS: [Row; 5] = [ROW; 5];
