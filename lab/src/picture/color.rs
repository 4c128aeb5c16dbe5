//! Colours: sRGB bytes outside, linear light inside, and the ramps that show stretch.

/// An sRGB colour, one byte a channel.
pub type Srgb = [u8; 3];

/// A colour in linear light, each channel in [0, 1]; shading and averaging happen here.
pub type Linear = [f32; 3];

/// Decodes sRGB to linear light (IEC 61966-2-1).
pub fn to_linear(color: Srgb) -> Linear {
    color.map(|byte| {
        let v = f32::from(byte) / 255.0;
        if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
}

/// Encodes linear light as sRGB; channels outside [0, 1] are clipped.
pub fn to_srgb(color: Linear) -> Srgb {
    color.map(|v| {
        let v = v.clamp(0.0, 1.0);
        let v = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (v * 255.0 + 0.5) as u8
    })
}

/// `a` at 0, `b` at 1, channel by channel.
pub fn mix(a: Linear, b: Linear, t: f32) -> Linear {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// Strain (1 = 100 %) below which fabric keeps its own colour: real wovens stretch by about that much.
pub const STRAIN_FLOOR: f32 = 0.02;

/// Strain at which the ramps end; anything above has the last colour.
pub const STRAIN_CEILING: f32 = 0.20;

/// Strain by which the ramp's colour has fully replaced the fabric's.
const STRAIN_FULL: f32 = 0.035;

/// Which colours show over-stretching.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ramp {
    /// Yellow, orange, red, magenta: reads as heat.
    #[default]
    Heat,
    /// Pale yellow to near black by falling lightness alone, so that no difference of hue need be seen.
    ColorBlindSafe,
}

/// Stops of a ramp: strain and colour, strains ascending.
type Stops = [(f32, Srgb); 4];

const HEAT: Stops =
    [(STRAIN_FLOOR, [255, 221, 51]), (0.07, [255, 138, 24]), (0.13, [226, 28, 36]), (STRAIN_CEILING, [226, 10, 190])];

const SAFE: Stops =
    [(STRAIN_FLOOR, [252, 243, 160]), (0.07, [249, 165, 40]), (0.13, [176, 56, 80]), (STRAIN_CEILING, [38, 10, 60])];

impl Ramp {
    /// The pure colour of a strain, clipped to the ramp's ends.
    pub fn color(self, strain: f32) -> Srgb {
        let stops = match self {
            Self::Heat => HEAT,
            Self::ColorBlindSafe => SAFE,
        };
        let mut previous = stops[0];
        for stop in stops {
            if strain <= stop.0 {
                let span = stop.0 - previous.0;
                let t = if span > 0.0 { ((strain - previous.0) / span).clamp(0.0, 1.0) } else { 0.0 };
                return std::array::from_fn(|i| {
                    let (a, b) = (f32::from(previous.1[i]), f32::from(stop.1[i]));
                    (a + (b - a) * t + 0.5) as u8
                });
            }
            previous = stop;
        }
        previous.1
    }

    /// How much of the fabric's own colour the ramp replaces at a strain: 0 up to the floor, 1 soon above.
    pub fn weight(strain: f32) -> f32 {
        let t = ((strain - STRAIN_FLOOR) / (STRAIN_FULL - STRAIN_FLOOR)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_linear_light() {
        for byte in 0..=255u8 {
            assert_eq!(to_srgb(to_linear([byte; 3])), [byte; 3]);
        }
    }

    #[test]
    fn ramp_has_the_promised_colours() {
        for strain in [-0.5, 0.0, 0.0199, STRAIN_FLOOR] {
            assert_eq!(Ramp::weight(strain), 0.0, "{strain}");
        }
        assert_eq!(Ramp::weight(0.05), 1.0);
        assert_eq!(Ramp::Heat.color(0.02), HEAT[0].1);
        assert_eq!(Ramp::Heat.color(0.07), HEAT[1].1);
        assert_eq!(Ramp::Heat.color(0.13), HEAT[2].1);
        assert_eq!(Ramp::Heat.color(0.20), HEAT[3].1);
        assert_eq!(Ramp::Heat.color(9.0), HEAT[3].1);
    }

    #[test]
    fn the_safe_ramp_only_gets_darker() {
        let luminance = |strain: f32| {
            let [r, g, b] = to_linear(Ramp::ColorBlindSafe.color(strain));
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for step in 0..36 {
            let strain = STRAIN_FLOOR + 0.005 * step as f32;
            assert!(luminance(strain + 0.005) < luminance(strain), "at {strain}");
        }
    }
}
