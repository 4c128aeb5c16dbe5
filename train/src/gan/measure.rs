//! What the losses measure of fields and of cloths, as tensors.

use burn::Tensor;

use crate::nets::GRID;

/// Bilinear resampling from 32 to `g` places with the ends aligned, [g][32].
pub(super) fn resampling(g: usize) -> Vec<f32> {
    let mut m = vec![0.0; g * GRID];
    for i in 0..g {
        let at = i as f32 * (GRID - 1) as f32 / (g - 1) as f32;
        let low = (at.floor() as usize).min(GRID - 2);
        let share = at - low as f32;
        m[i * GRID + low] += 1.0 - share;
        m[i * GRID + low + 1] += share;
    }
    m
}

/// Mean square of the differences between neighbours of fields [batch, channels, rows, columns], along both sides.
pub(super) fn roughness(x: Tensor<4>) -> Tensor<1> {
    let [b, c, m, n] = x.dims();
    let down = x.clone().slice([0..b, 0..c, 1..m, 0..n]) - x.clone().slice([0..b, 0..c, 0..m - 1, 0..n]);
    let right = x.clone().slice([0..b, 0..c, 0..m, 1..n]) - x.slice([0..b, 0..c, 0..m, 0..n - 1]);
    (down.square().mean() + right.square().mean()) * 0.5
}

/// Strains of the structural springs along u, then along v, of positions [batch, g * g, 3]: [batch, 2 g (g - 1)].
pub(super) fn strains(x: Tensor<3>, g: usize) -> Tensor<2> {
    let [b, _, _] = x.dims();
    let rest = 1.0 / (g - 1) as f64;
    let x = x.reshape([b, g, g, 3]);
    let strain = |a: Tensor<4>, c: Tensor<4>| {
        let length = ((a - c).square().sum_dim(3) + 1e-12).sqrt();
        (length / rest - 1.0).reshape([b, g * (g - 1)])
    };
    let along_u = strain(x.clone().slice([0..b, 0..g, 1..g, 0..3]), x.clone().slice([0..b, 0..g, 0..g - 1, 0..3]));
    let along_v = strain(x.clone().slice([0..b, 1..g, 0..g, 0..3]), x.slice([0..b, 0..g - 1, 0..g, 0..3]));
    Tensor::cat(vec![along_u, along_v], 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use burn::tensor::{Device, TensorData};

    #[test]
    fn roughness_is_the_mean_square_of_steps() {
        // one step of 2 between the columns of 2 x 2, none between the rows
        let x = Tensor::<4>::from_data(TensorData::new(vec![1.0f32, 3.0, 1.0, 3.0], [1, 1, 2, 2]), &Device::flex());
        assert_eq!(roughness(x.clone()).into_scalar::<f32>(), 2.0);
        assert_eq!(roughness(x * 0.0 + 7.0).into_scalar::<f32>(), 0.0);
    }

    #[test]
    fn resampling_keeps_planes_and_ends() {
        for g in [2, 16, 32, 50] {
            let m = resampling(g);
            for (i, row) in m.chunks_exact(GRID).enumerate() {
                let at: f32 = row.iter().enumerate().map(|(j, w)| j as f32 * w).sum();
                let expected = i as f32 * (GRID - 1) as f32 / (g - 1) as f32;
                assert!((at - expected).abs() < 1e-4 && (row.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{g} {i}");
            }
        }
    }
}
