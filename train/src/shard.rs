use std::str::FromStr;

/// A part of the work: every n-th job from the i-th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// Whether job number `job`, from 0 on, is part of it.
    pub fn has(self, job: usize) -> bool {
        job % self.count + 1 == self.index
    }

    /// Name of its file among those of a figure.
    pub fn file(self, figure: &str) -> String {
        match self.count {
            1 => format!("figure-{figure}.jsonl"),
            n => format!("figure-{figure}.{}-of-{n}.jsonl", self.index),
        }
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) && count <= 10_000 => Ok(Shard { index, count }),
            _ => Err("must be I/N with I from 1 to N, such as 2/8".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_is_in_one_shard() {
        for count in 1..7 {
            let shards: Vec<Shard> = (1..=count).map(|i| format!("{i}/{count}").parse().unwrap()).collect();
            for job in 0..50 {
                assert_eq!(shards.iter().filter(|s| s.has(job)).count(), 1, "job {job} of {count} shards");
            }
            let mut files: Vec<String> = shards.iter().map(|s| s.file("8")).collect();
            files.dedup();
            assert_eq!(files.len(), count);
        }
        assert_eq!("1/1".parse(), Ok(Shard::WHOLE));
        for bad in ["0/2", "3/2", "1", "a/b", "1/0", "-1/2", "1/99999"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
