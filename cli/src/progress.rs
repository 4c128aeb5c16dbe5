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

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
