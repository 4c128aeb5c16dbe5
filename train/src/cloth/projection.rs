//! From a stiffness field to spring stiffness that the step can carry: the f64, differentiable twin of core's `tuned`
//! budget.

use super::springs::{BEND, CHANNELS, Springs, WARP, WEFT};

/// Share f of the flat sheet's stability limit that the `tuned` budget fills.
pub const TUNED_FRACTION: f64 = 0.8;

/// Largest bend stiffness as a share of the mean of warp and weft: a free bend channel would carry the load that the
/// structural springs should carry.
pub const BEND_SHARE: f64 = 0.02;

/// Inertia field q, one number per particle: clip(radius / distance to the nearest pin, 1, most), the distance taken in
/// the flat sheet. 1 everywhere where nothing is pinned or the radius is 0. `pinned` has one entry per particle.
pub fn inertia(springs: &Springs, pinned: &[bool], radius_m: f64, most: f64) -> Vec<f64> {
    let pins: Vec<[f64; 2]> = (0..pinned.len()).filter(|&i| pinned[i]).map(|i| springs.flat(i)).collect();
    let q = |i: usize| {
        let [u, v] = springs.flat(i);
        let nearest = pins.iter().map(|p| (p[0] - u).hypot(p[1] - v)).fold(f64::INFINITY, f64::min);
        // At a pin 0/0 or x/0 must not be asked for; q has no effect there.
        if nearest > 0.0 { (radius_m / nearest).clamp(1.0, most) } else { most }
    };
    (0..pinned.len()).map(q).collect()
}

/// What the budget is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Length of a substep in s.
    pub dt_s: f64,
    /// Damping c in 1/s.
    pub damping_per_s: f64,
    /// Share of the limit, [`TUNED_FRACTION`].
    pub fraction: f64,
    /// Inertial mass M_i = q_i m of each particle in kg.
    pub inertial_mass_kg: Vec<f64>,
    /// Whether each particle is pinned: it carries any stiffness.
    pub pinned: Vec<bool>,
}

impl Budget {
    /// Largest eigenvalue of B_i in N/m that particle `i` carries: f (4/dt^2 - 2 c/dt) M_i. Damping enters the
    /// stability limit of symplectic Euler as omega^2 dt^2 < 4 - 2 c dt.
    fn cap(&self, i: usize) -> f64 {
        self.fraction
            * (4.0 / (self.dt_s * self.dt_s) - 2.0 * self.damping_per_s / self.dt_s)
            * self.inertial_mass_kg[i]
    }
}

/// A projected field: the stiffness of every spring, and what the gradient needs.
///
/// 1. bend = min(bend, 0.02 mean(warp, weft)) at each particle;
/// 2. raw stiffness of a spring = mean of its channel at its two ends;
/// 3. B_i = sum over the springs of particle i of (1 + \[other end free\]) k n n^T, a 2 x 2 matrix in the flat sheet;
/// 4. s_i = min(1, cap_i / largest eigenvalue of B_i), 1 where pinned;
/// 5. k = raw stiffness times the smaller s of its two ends: all channels alike, so that their ratios survive.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    stiffness: Vec<f64>,
    raw: Vec<f64>,
    scale: Vec<f64>,
    /// d s_i / d B_i, symmetric (uu, uv, vv); zero where s_i = 1.
    slope: Vec<[f64; 3]>,
    /// Whether the bend channel was cut at each particle.
    bend_cut: Vec<bool>,
}

impl Projection {
    /// Projects `field`, `[channel][row][column]` in N/m, each at least 0. The lengths of `field` and of the budget must
    /// fit the springs; [`super::Scene`] sees to that.
    pub fn new(springs: &Springs, budget: &Budget, field: &[f64]) -> Projection {
        let n = springs.particles();
        let mut field = field.to_vec();
        let mut bend_cut = vec![false; n];
        for i in 0..n {
            let most = BEND_SHARE * 0.5 * (field[WARP * n + i] + field[WEFT * n + i]);
            if field[BEND * n + i] > most {
                field[BEND * n + i] = most;
                bend_cut[i] = true;
            }
        }
        let mut raw = Vec::with_capacity(springs.list().len());
        let mut sums = vec![[0.0f64; 3]; n];
        for s in springs.list() {
            let k = 0.5 * (field[s.channel * n + s.a] + field[s.channel * n + s.b]);
            raw.push(k);
            let [u, v] = s.direction;
            for (end, other) in [(s.a, s.b), (s.b, s.a)] {
                let w = weight(budget, other) * k;
                sums[end][0] += w * u * u;
                sums[end][1] += w * u * v;
                sums[end][2] += w * v * v;
            }
        }
        let mut scale = vec![1.0; n];
        let mut slope = vec![[0.0; 3]; n];
        for i in (0..n).filter(|&i| !budget.pinned[i]) {
            let (largest, gradient) = largest_eigenvalue(sums[i]);
            let s = budget.cap(i) / largest;
            if s < 1.0 {
                scale[i] = s;
                slope[i] = gradient.map(|g| -s / largest * g);
            }
        }
        let stiffness = springs.list().iter().zip(&raw).map(|(s, k)| k * scale[s.a].min(scale[s.b])).collect();
        Projection { stiffness, raw, scale, slope, bend_cut }
    }

    /// Stiffness of every spring in N/m, in the order of [`Springs::list`].
    pub fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    /// Factor s of every particle, 0 to 1.
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }

    /// How much of the springs' total stiffness (after the bend cut) the budget took away, 0 to 1.
    pub fn cut_fraction(&self) -> f64 {
        let (kept, raw) = (self.stiffness.iter().sum::<f64>(), self.raw.iter().sum::<f64>());
        if raw > 0.0 { 1.0 - kept / raw } else { 0.0 }
    }

    /// Vector-Jacobian product: from the gradient of a loss with respect to every spring's stiffness to the gradient with
    /// respect to the field, `[channel][row][column]`. Where two choices of a minimum tie, the gradient is their mean.
    pub fn vjp(&self, springs: &Springs, budget: &Budget, spring_gradient: &[f64]) -> Vec<f64> {
        let n = springs.particles();
        let mut by_scale = vec![0.0; n];
        for ((s, &g), &raw) in springs.list().iter().zip(spring_gradient).zip(&self.raw) {
            let (a, b) = (self.scale[s.a], self.scale[s.b]);
            let share = if a == b { 0.5 } else { f64::from(a < b) };
            by_scale[s.a] += share * g * raw;
            by_scale[s.b] += (1.0 - share) * g * raw;
        }
        let mut field = vec![0.0; CHANNELS * n];
        for (s, &g) in springs.list().iter().zip(spring_gradient) {
            let [u, v] = s.direction;
            let mut by_raw = g * self.scale[s.a].min(self.scale[s.b]);
            for (end, other) in [(s.a, s.b), (s.b, s.a)] {
                let [uu, uv, vv] = self.slope[end];
                by_raw += by_scale[end] * weight(budget, other) * (uu * u * u + 2.0 * uv * u * v + vv * v * v);
            }
            field[s.channel * n + s.a] += 0.5 * by_raw;
            field[s.channel * n + s.b] += 0.5 * by_raw;
        }
        for i in (0..n).filter(|&i| self.bend_cut[i]) {
            let g = 0.5 * BEND_SHARE * std::mem::take(&mut field[BEND * n + i]);
            field[WARP * n + i] += g;
            field[WEFT * n + i] += g;
        }
        field
    }
}

/// A free neighbour may swing against the particle, which doubles what the spring adds to the frequency.
fn weight(budget: &Budget, other: usize) -> f64 {
    if budget.pinned[other] { 1.0 } else { 2.0 }
}

/// Largest eigenvalue of the symmetric matrix (uu, uv, vv), and its gradient e e^T as (uu, uv, vv) where the uv entry
/// counts once. Of a double eigenvalue every unit e is as good; their mean, I/2, keeps the symmetry of the sheet.
fn largest_eigenvalue([uu, uv, vv]: [f64; 3]) -> (f64, [f64; 3]) {
    let (mean, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
    let radius = half.hypot(uv);
    if radius <= 1e-13 * mean {
        return (mean, [0.5, 0.0, 0.5]);
    }
    // e = (cos t, sin t) with cos 2t = half/radius, sin 2t = uv/radius.
    let (c, s) = (half / radius, uv / radius);
    (mean + radius, [0.5 * (1.0 + c), 0.5 * s, 0.5 * (1.0 - c)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reproducible numbers in 0..1.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        move || {
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            (x >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn setting(dt_s: f64) -> (Springs, Budget, Vec<f64>) {
        let springs = Springs::new(6, 7, 1.0, 0.8).unwrap();
        let mut pinned = vec![false; 42];
        pinned[0] = true;
        pinned[6] = true;
        let mass = 0.2 * 0.8 / 42.0;
        let inertial_mass_kg = inertia(&springs, &pinned, 0.3, 32.0).iter().map(|q| q * mass).collect();
        let mut next = noise(3);
        let field = (0..4 * 42).map(|j| [900.0, 1500.0, 300.0, 25.0][j / 42] * (0.5 + next())).collect();
        (springs, Budget { dt_s, damping_per_s: 2.0, fraction: TUNED_FRACTION, inertial_mass_kg, pinned }, field)
    }

    #[test]
    fn vjp_agrees_with_finite_differences() {
        // Clamped everywhere but at the pins, partly, and nowhere.
        for (dt, least, most) in [(1.0 / 120.0, 0.3, 0.99), (1.0 / 600.0, 0.01, 0.7), (1.0 / 20_000.0, 0.0, 0.0)] {
            let (springs, budget, field) = setting(dt);
            let mut next = noise(5);
            let weights: Vec<f64> = springs.list().iter().map(|_| next() - 0.5).collect();
            let loss = |field: &[f64]| -> f64 {
                let p = Projection::new(&springs, &budget, field);
                p.stiffness().iter().zip(&weights).map(|(k, w)| k * w).sum()
            };
            let p = Projection::new(&springs, &budget, &field);
            assert!((least..=most).contains(&p.cut_fraction()), "{}", p.cut_fraction());
            assert!(p.bend_cut.iter().any(|&c| c) && !p.bend_cut.iter().all(|&c| c));
            let gradient = p.vjp(&springs, &budget, &weights);
            for j in 0..field.len() {
                let at = |h: f64| {
                    let mut f = field.clone();
                    f[j] += h;
                    loss(&f)
                };
                let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
                assert!(
                    (difference - gradient[j]).abs() < 1e-5 * (0.1 + difference.abs()),
                    "{difference} {}",
                    gradient[j]
                );
            }
        }
    }

    #[test]
    fn fills_the_cap_and_keeps_ratios() {
        let (springs, budget, _) = setting(1.0 / 240.0);
        let n = springs.particles();
        let field: Vec<f64> = (0..4 * n).map(|j| [4000.0, 2000.0, 500.0, 1.0][j / n]).collect();
        let p = Projection::new(&springs, &budget, &field);
        let mut sums = vec![[0.0; 3]; n];
        for (s, k) in springs.list().iter().zip(p.stiffness()) {
            let [u, v] = s.direction;
            for (end, other) in [(s.a, s.b), (s.b, s.a)] {
                for (sum, part) in sums[end].iter_mut().zip([u * u, u * v, v * v]) {
                    *sum += weight(&budget, other) * k * part;
                }
            }
        }
        let load = |i: usize| largest_eigenvalue(sums[i]).0 / budget.cap(i);
        assert!((0..n).filter(|&i| !budget.pinned[i]).all(|i| load(i) <= 1.0 + 1e-12));
        assert!((0..n).any(|i| load(i) > 1.0 - 1e-9));
        assert!(p.cut_fraction() > 0.5 && budget.pinned.iter().zip(p.scale()).all(|(&pin, &s)| !pin || s == 1.0));
    }

    #[test]
    fn inertia_is_clipped() {
        let (springs, budget, _) = setting(1e-3);
        let q = inertia(&springs, &budget.pinned, 0.3, 32.0);
        assert_eq!(q[1], 0.3 / (1.0 / 6.0));
        assert_eq!(q[41], 1.0);
        assert!(inertia(&springs, &[false; 42], 0.3, 32.0).iter().all(|&q| q == 1.0));
        assert!(inertia(&springs, &budget.pinned, 0.0, 1.0).iter().all(|&q| q == 1.0));
    }
}
