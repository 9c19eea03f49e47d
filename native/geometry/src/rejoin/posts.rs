//! Vertices of lines at which something stays as it was.

use glam::DVec3;

use super::Line;

impl Line {
    /// How many vertices sheets have along it at least.
    pub(super) fn fewest(&self) -> usize {
        if self.stays { self.points.len() } else { 2 }
    }

    /// Which of so many vertices along the line stands at each of its points: the nearest by length,
    /// each another.
    #[must_use]
    pub fn posts(&self, n: usize) -> Vec<usize> {
        let n_steps = if self.is_closed { n } else { n - 1 };
        let m = self.points.len();
        let mut posts: Vec<usize> = Vec::with_capacity(m);
        for (j, share) in self.shares().into_iter().enumerate() {
            let wanted = (share * n_steps as f64).round() as usize;
            let least = posts.last().map_or(0, |last| last + 1);
            posts.push(wanted.max(least).min((n + j).saturating_sub(m)));
        }
        posts
    }

    /// The shares of the line before each of its points.
    fn shares(&self) -> Vec<f64> {
        let mut lengths = vec![0.0];
        for [a, b] in self.pieces() {
            lengths.push(lengths[lengths.len() - 1] + a.distance(b));
        }
        let whole = lengths[lengths.len() - 1].max(f64::MIN_POSITIVE);
        let points = lengths.iter().take(self.points.len());
        points.map(|length| length / whole).collect()
    }

    /// Places of so many vertices: those at its points, the others evenly between.
    pub(super) fn between_posts(&self, n: usize) -> Vec<DVec3> {
        let posts = self.posts(n);
        let mut places = Vec::with_capacity(n);
        for (j, [a, b]) in self.pieces().enumerate() {
            let to = posts.get(j + 1).copied().unwrap_or(n);
            let n_steps = to - posts[j];
            places.extend((0..n_steps).map(|i| a.lerp(b, i as f64 / n_steps as f64)));
        }
        if !self.is_closed {
            places.extend(self.points.last());
        }
        places
    }
}
