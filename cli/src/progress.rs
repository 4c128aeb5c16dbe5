//! A progress bar on stderr, where that is a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// Parts of one setting on the bar.
const PARTS: u64 = 1000;

/// A bar over settings that are simulated one after the other. It vanishes when it is dropped.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar for so many settings.
    pub fn new(settings: usize) -> Progress {
        let bar = ProgressBar::new(settings as u64 * PARTS);
        // a template that does not parse leaves the plain bar
        if let Ok(style) = ProgressStyle::with_template("{msg:18} [{bar:40}] {percent:>3} %  {elapsed}") {
            bar.set_style(style.progress_chars("=> "));
        }
        Progress { bar }
    }

    /// The share (0 to 1) of the setting `index` that is done.
    pub fn at(&self, index: usize, name: &'static str, share: f32) {
        let position = index as u64 * PARTS + (share * PARTS as f32) as u64;
        if position != self.bar.position() || share >= 1.0 {
            self.bar.set_message(name);
            self.bar.set_position(position);
        }
    }
}

/// A bar over work of known size, with the time that is left. It vanishes when it is dropped.
pub struct Work {
    bar: ProgressBar,
}

/// Units of work on the bar: what is counted in particle-steps would leave nothing of a u64 for the rates.
const UNIT: f64 = 1e4;

impl Work {
    /// A bar over so much work in total.
    pub fn new(total: f64) -> Work {
        let bar = ProgressBar::new((total / UNIT) as u64);
        if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {percent:>3} %  {elapsed}, {eta} left  {wide_msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.enable_steady_tick(std::time::Duration::from_secs(1));
        Work { bar }
    }

    /// What is worked on.
    pub fn at(&self, name: &str) {
        self.bar.set_message(name.to_string());
    }

    /// So much more is done.
    pub fn done(&self, work: f64) {
        self.bar.inc((work / UNIT) as u64);
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
