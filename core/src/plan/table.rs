use super::{FabricLaw, Price, Row, StepLaw};
const LAW: StepLaw = StepLaw { constant: 0.0, grid: 0.0, step: 0.0, margin: 0.0 };
const FABRIC: FabricLaw = FabricLaw { constant: 0.0, grid: 0.0, warp: 0.0, weft: 0.0, shear: 0.0, margin: 0.0 };
const PRICE: Price = Price { constant: 1.0, grid: 0.0, step: 0.0 };
const ROW: Row = Row {
    plain: LAW,
    inertia: LAW,
    tethers: LAW,
    fabric: FABRIC,
    plain_price: PRICE,
    tethers_price: PRICE,
    levels_price: PRICE,
    implicit_price: PRICE,
};
pub(super) const ROWS: [Row; 5] = [ROW; 5];
