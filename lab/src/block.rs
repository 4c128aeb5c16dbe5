//! Memory of a cloth as an engine hands it in: from a cache line on. Wherever else it begins, vectors lie across two lines, and
//! a step takes a fifth to two fifths longer.

const LINE: usize = 64;
const NUMBERS: usize = LINE / size_of::<f32>();

/// Numbers from a cache line on.
pub struct Block {
    numbers: Vec<f32>,
    first: usize,
    count: usize,
}

impl Block {
    /// So many numbers, all 0.
    pub fn new(count: usize) -> Block {
        let numbers = vec![0.0; count + NUMBERS];
        let first = numbers.as_ptr().align_offset(LINE).min(NUMBERS);
        Block { numbers, first, count }
    }

    /// The same, kept as long as the program runs.
    pub fn leaked(count: usize) -> &'static mut [f32] {
        Box::leak(Box::new(Block::new(count))).numbers_mut()
    }

    /// The numbers.
    pub fn numbers_mut(&mut self) -> &mut [f32] {
        &mut self.numbers[self.first..self.first + self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_on_a_line() {
        for count in [0, 1, 16, 1000, 100_000] {
            let mut block = Block::new(count);
            assert_eq!((block.numbers_mut().len(), block.numbers_mut().as_ptr().align_offset(LINE)), (count, 0));
        }
    }
}
