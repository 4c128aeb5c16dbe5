//! Reads numbers off the bytes that the fuzzer made; zeros when they have ended.
#![allow(dead_code, reason = "every target uses its own part")]

pub struct Input<'a>(pub &'a [u8]);

impl Input<'_> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        let n = self.0.len().min(N);
        bytes[..n].copy_from_slice(&self.0[..n]);
        self.0 = &self.0[n..];
        bytes
    }

    pub fn u8(&mut self) -> u8 {
        self.take::<1>()[0]
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    /// Any bits.
    pub fn f32(&mut self) -> f32 {
        f32::from_bits(self.u32())
    }

    /// Any bits, or mostly a number of the size of things in a scene: -32 to 32 in steps of a thousandth.
    pub fn near(&mut self) -> f32 {
        match self.u8() {
            255 => self.f32(),
            _ => f32::from(i16::from_le_bytes(self.take())) * 1e-3,
        }
    }

    /// One of some values.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> Option<T> {
        let place = usize::from(self.u8());
        of.get(place % of.len().max(1)).copied()
    }

    pub fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }
}
