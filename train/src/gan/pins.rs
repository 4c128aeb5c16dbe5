//! What a net is told of pins.

use taut::noise;

use crate::nets::GRID;

/// A few pins somewhere, none, or a whole row, for the first stage: what the words mean does not depend on them.
pub(super) fn random_pins(bits: u64) -> Vec<usize> {
    if bits % 5 == 4 {
        let row = (noise::bits(bits, 0) % GRID as u64) as usize;
        return (row * GRID..(row + 1) * GRID).collect();
    }
    (0..bits % 5).map(|i| (noise::bits(bits, i as u32) % (GRID * GRID) as u64) as usize).collect()
}

/// Distance to the nearest pin over the side, clipped to 1, [32][32]; 1 where nothing is pinned. `pins` are particles of the
/// 32 x 32 grid of a square sheet. The runtime computes the same for every grid and sheet (a test compares the two).
pub fn pin_map(pins: &[usize]) -> Vec<f32> {
    let last = (GRID - 1) as f32;
    (0..GRID * GRID)
        .map(|i| {
            let distance = |p: &usize| {
                let (du, dv) = ((i % GRID) as f32 - (p % GRID) as f32, (i / GRID) as f32 - (p / GRID) as f32);
                (du * du + dv * dv).sqrt() / last
            };
            pins.iter().map(distance).fold(1.0, f32::min)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_of_the_first_stage_are_none_some_or_a_row() {
        let drawn: Vec<Vec<usize>> = (0..50).map(|i| random_pins(noise::bits(3, i))).collect();
        assert!(drawn.iter().flatten().all(|p| *p < GRID * GRID));
        for n in [0, 1, 2, 3, GRID] {
            assert!(drawn.iter().any(|pins| pins.len() == n), "{n}");
        }
    }
}
