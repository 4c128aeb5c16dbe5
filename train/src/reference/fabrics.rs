//! The seven fabrics that are measured here: constants of Wang, O'Brien and Ramamoorthi ("Data-Driven Elastic Models for
//! Cloth", 2011), as ARCSim 0.2.1 carries them. What they are for and how heavy they are stands with their kind in
//! [`taut_lab::fabric`].

use taut_lab::fabric::{KINDS, Kind};

use super::ReferenceError;
use super::material::{Bending, BendingTable, Membrane, StretchingTable};

/// A fabric with its measured tables.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Name of the sample.
    pub name: &'static str,
    /// Name of its kind in [`taut_lab::fabric::KINDS`].
    pub kind: &'static str,
    /// In N/m, half of what acts.
    pub stretching: StretchingTable,
    /// In N m.
    pub bending: BendingTable,
}

impl Measured {
    /// The fabric of a name. Error: [`ReferenceError::Fabric`].
    pub fn named(name: &str) -> Result<&'static Measured, ReferenceError> {
        MEASURED.iter().find(|f| f.name == name).ok_or_else(|| ReferenceError::Fabric(name.into()))
    }

    /// Its kind.
    pub fn kind(&self) -> Result<&'static Kind, ReferenceError> {
        KINDS.iter().find(|k| k.name == self.kind).ok_or_else(|| ReferenceError::Fabric(self.kind.into()))
    }

    /// What the cloth is made of. Error: [`ReferenceError::Fabric`] where no kind has its name.
    pub fn material(&self) -> Result<Material, ReferenceError> {
        Ok(Material {
            density_kg_m2: f64::from(self.kind()?.density_kg_m2),
            membrane: Membrane::measured(&self.stretching),
            bending: Bending::measured(&self.bending),
        })
    }
}

/// What a cloth is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Mass per area in kg/m^2.
    pub density_kg_m2: f64,
    /// How it stretches.
    pub membrane: Membrane,
    /// How it bends.
    pub bending: Bending,
}

/// All of them.
#[rustfmt::skip]
pub const MEASURED: [Measured; 7] = [
    Measured {
        name: "11oz-black-denim", kind: "denim",
        stretching: [
            [205.352005, 10.234077, 1013.88629, 53.387184],
            [232.027634, 40.646339, 1052.84289, 64.980499],
            [224.592209, 40.384563, 1054.43444, 67.184807],
            [225.95105, 62.095657, 1059.59741, 83.99202],
            [226.039566, 40.502792, 1058.27771, 75.118423],
            [225.767487, 40.917892, 1051.55712, 71.810631],
        ],
        bending: [
            [6.4196457e-05, 6.0286175e-05, 6.0943428e-05, 6.2433697e-05, 1.9824701e-05],
            [7.3384567e-05, 5.9671982e-05, 6.1080757e-05, 6.8242569e-05, 3.6033474e-05],
            [9.6951576e-05, 0.000107848228, 0.000113060738, 0.00012056974, 7.9781021e-05],
        ],
    },
    Measured {
        name: "gray-interlock", kind: "jersey",
        stretching: [
            [16.593832, -14.69599, 34.477123, 36.860302],
            [46.364765, 53.694656, 261.013855, -29.691301],
            [49.28511, 87.5961, 206.373993, 22.768457],
            [123.98922, 105.18177, 365.966217, 44.217571],
            [139.686325, 73.59256, 413.553162, -174.43853],
            [127.44381, 85.848587, 405.872833, 32.238411],
        ],
        bending: [
            [2.3191698e-05, 3.2932217e-05, 3.4406498e-05, 3.901442e-05, 2.3382786e-05],
            [2.4749964e-05, 1.8651314e-05, 1.6370552e-05, 2.5095791e-05, 8.860165e-06],
            [1.4267624e-05, 7.052906e-06, 1.4515154e-05, 2.4665127e-05, 1.9383726e-05],
        ],
    },
    Measured {
        name: "ivory-rib-knit", kind: "rib knit",
        stretching: [
            [42.871021, -0.234556, 65.166023, 83.175644],
            [52.422512, 7.219094, 245.337158, -31.129513],
            [29.482058, -5.146112, 127.130753, 13.068157],
            [91.209549, 4.940307, 109.746452, 27.60943],
            [48.973385, -0.967226, 147.696823, -49.282963],
            [105.649139, 0.416488, 254.593491, 3.472504],
        ],
        bending: [
            [4.6237591e-05, 6.3086697e-05, 8.3192772e-05, 9.7574425e-05, 8.0726685e-05],
            [3.001593e-05, 3.0097424e-05, 3.0172081e-05, 3.06483e-05, 2.4726685e-05],
            [3.2243889e-05, 3.7341282e-05, 3.8817448e-05, 3.9812527e-05, 3.043782e-05],
        ],
    },
    Measured {
        name: "navy-sparkle-sweat", kind: "sweatshirt knit",
        stretching: [
            [12.486332, -19.875324, 3.272434, 17.616289],
            [32.172089, 56.01276, 283.46637, -2.438436],
            [48.565407, 94.126335, 180.101227, 4.43908],
            [77.093796, 2.958664, 91.25116, 6.1077],
            [126.205986, 84.471718, 305.131531, 38.495132],
            [92.34317, 117.527084, 243.264908, 47.338436],
        ],
        bending: [
            [5.9469658e-05, 3.7500004e-05, 3.5787308e-05, 3.5737106e-05, 2.1033506e-05],
            [4.0072277e-05, 3.7446949e-05, 3.5206612e-05, 2.4871773e-05, 9.033506e-06],
            [4.5625023e-05, 3.9520981e-05, 3.0734119e-05, 2.3301662e-05, 1.3033506e-05],
        ],
    },
    Measured {
        name: "pink-ribbon-brown", kind: "blanket",
        stretching: [
            [151.503906, 106.02816, 244.830673, 30.250183],
            [164.124344, 33.689709, 268.195221, 30.074625],
            [152.584641, 107.251373, 210.614838, -62.760571],
            [209.604172, 175.223465, 220.19812, 129.643188],
            [98.879021, 107.085518, 326.209442, 44.475986],
            [96.805817, 54.626881, 359.792633, 30.340616],
        ],
        bending: [
            [0.000117070122, 0.000202682922, 0.000298615936, 0.000244588867, 0.00023843782],
            [8.7509773e-05, 3.6396919e-05, 0.000103628098, 9.1630119e-05, 9.7175949e-05],
            [5.9774277e-05, 5.9260632e-05, 6.4199661e-05, 5.5017326e-05, 5.9221714e-05],
        ],
    },
    Measured {
        name: "white-dots-on-blk", kind: "tablecloth",
        stretching: [
            [2002.08618, 0.345588, 2027.48559, 19.189022],
            [2107.22753, 36.371597, 2171.73339, 16.904713],
            [2107.29882, 57.936157, 2153.30712, 24.392872],
            [2107.73291, 28.389059, 2132.72607, 101.462021],
            [2106.9375, 70.149529, 2121.87353, 38.054455],
            [2107.30786, 61.21629, 2150.4768, 37.668823],
        ],
        bending: [
            [5.1713814e-05, 3.6506981e-05, 6.6360748e-05, 5.2729267e-05, 1.5221714e-05],
            [4.065947e-05, 1.0401686e-05, 2.084782e-05, 3.0993469e-05, 1.2726685e-05],
            [3.1282822e-05, 2.2910311e-05, 2.6350384e-05, 3.0637762e-05, 1.6726685e-05],
        ],
    },
    Measured {
        name: "white-swim-solid", kind: "swimwear knit",
        stretching: [
            [47.971176, 6.834521, 104.615456, 60.773663],
            [40.369045, 23.092957, 169.66629, -24.68189],
            [40.291599, 48.142597, 138.261612, 9.002558],
            [51.393467, -32.966949, 79.881721, 35.973194],
            [51.500938, 1.86891, 63.693932, -37.540417],
            [68.621185, 40.13195, 124.468513, 36.199604],
        ],
        bending: [
            [6.0237942e-05, 5.6357208e-05, 6.9698593e-05, 5.5305969e-05, 3.4705532e-05],
            [5.8803211e-05, 6.3121964e-05, 6.1379181e-05, 4.7971302e-05, 1.9383726e-05],
            [5.1018833e-05, 5.0741455e-05, 5.0570576e-05, 5.0006001e-05, 2.4556618e-05],
        ],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    /// [`taut_lab::fabric`] cites what the engine makes of the tables; both must tell the same cloth.
    #[test]
    fn the_tables_are_those_that_the_kinds_cite() {
        for fabric in &MEASURED {
            let kind = fabric.kind().unwrap();
            let material = fabric.material().unwrap();
            let k = |strain: [f64; 3]| material.membrane.stiffness(strain);
            let rest = k([0.0; 3]);
            let green = |stretch: f64| 0.5 * (stretch * stretch - 1.0);
            // a knit: tension over stretch at 10 %, lateral fixed; shear at 5 % along u or v
            let e = green(1.1);
            let knit = [k([e, 0.0, 0.0])[0] * e * 1.1 / 0.1, k([0.0, e, 0.0])[2] * e * 1.1 / 0.1];
            let [uu, vv, _] = kind.membrane.map(f64::from);
            let (mine, cited) =
                if kind.words.contains(&"knit") { (knit, [uu, vv]) } else { ([rest[0], rest[2]], [uu, vv]) };
            for (mine, cited) in mine.iter().zip(cited) {
                assert!((mine / cited - 1.0).abs() < 2e-3, "{}: {mine} {cited}", fabric.name);
            }
            if !kind.words.contains(&"knit") {
                assert!((rest[3] / f64::from(kind.membrane[2]) - 1.0).abs() < 2e-3, "{}: {rest:?}", fabric.name);
            }
            let mean = material.bending.rigidities().iter().sum::<f64>() / 3.0;
            assert!((mean / f64::from(kind.hinge_rigidity_n_m) - 1.0).abs() < 0.02, "{}: {mean}", fabric.name);
        }
        assert!(Measured::named("velvet").is_err());
    }

    #[test]
    fn at_rest_a_knit_is_stiffer_than_its_table_says() {
        let membrane = Measured::named("navy-sparkle-sweat").unwrap().material().unwrap().membrane;
        // 2 x 3.27 N/m in the table
        let rest = membrane.stiffness([0.0; 3]);
        for (k, cited) in rest.iter().zip([30.89, 0.0, 46.24, 34.72]) {
            assert!((k - cited).abs() < 0.01, "{rest:?}");
        }
    }
}
