//! Who hears whose words.

use crate::nets::init::SplitMix64;

/// A permutation of 0..n that leaves nothing in its place (Sattolo 1986: one cycle through all), for n of 2 or more.
pub fn derangement(n: usize, seed: u64) -> Vec<usize> {
    let mut stream = SplitMix64::new(seed);
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        let j = (stream.next_u64() % i as u64) as usize;
        order.swap(i, j);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_stays_in_its_place() {
        for n in 2..40 {
            for seed in 0..20 {
                let order = derangement(n, seed);
                assert!(order.iter().enumerate().all(|(i, j)| i != *j), "{order:?}");
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert!(sorted.into_iter().eq(0..n));
            }
        }
        assert_ne!(derangement(9, 1), derangement(9, 2));
    }
}
