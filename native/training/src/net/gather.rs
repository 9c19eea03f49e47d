//! Rows that are sums of some rows of another tensor, with the gradient.
//!
//! burn's own `select` and its adding counterpart do the same by numbers alone. On a GPU they give
//! one thread a whole column, because two numbers may be the same; with the lists of either
//! direction at hand a thread has one element, and nothing is added by two.

use std::sync::Arc;

use burn::backend::Dispatch;
use burn::tensor::Tensor;

use super::backend::GraphOps;

/// For every row of a result, the rows that it is the sum of; and back, for the gradient.
#[derive(Clone, Debug)]
pub struct Gather {
    pub(super) to: Arc<Table>,
    from: Arc<Table>,
}

/// Lists of rows, one after another.
#[derive(PartialEq, Eq, Debug)]
pub(super) struct Table {
    /// Where each list starts, and the end of the last.
    pub starts: Vec<u32>,
    /// All lists.
    pub rows: Vec<u32>,
}

impl Gather {
    /// Row i is the row `rows[i]` of `n`.
    ///
    /// # Panics
    /// If a row is not below `n`.
    pub fn of_rows(rows: Vec<u32>, n: usize) -> Self {
        let mut starts = vec![0; n + 1];
        for &row in &rows {
            starts[row as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut back = vec![0; rows.len()];
        for (i, &row) in rows.iter().enumerate() {
            let place = &mut next[row as usize];
            back[*place as usize] = i as u32;
            *place += 1;
        }
        let to = Table {
            starts: (0..=rows.len() as u32).collect(),
            rows,
        };
        let from = Table { starts, rows: back };
        Self {
            to: Arc::new(to),
            from: Arc::new(from),
        }
    }

    /// The transpose: where a row went to, it comes from.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            to: self.from.clone(),
            from: self.to.clone(),
        }
    }

    /// How many rows each row is the sum of.
    pub fn counts(&self) -> Vec<f32> {
        let ends = self.to.starts.windows(2);
        ends.map(|ends| (ends[1] - ends[0]) as f32).collect()
    }
}

impl Table {
    /// The sums, `width` numbers a row.
    pub fn sums(&self, rows: &[f32], width: usize) -> Vec<f32> {
        let mut sums = vec![0.0; (self.starts.len() - 1) * width];
        for (sum, ends) in sums.chunks_exact_mut(width).zip(self.starts.windows(2)) {
            for &row in &self.rows[ends[0] as usize..ends[1] as usize] {
                let row = &rows[row as usize * width..][..width];
                sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += x);
            }
        }
        sums
    }
}

/// The sums of rows that a gather lists.
pub fn gathered(rows: Tensor<2>, gather: &Gather) -> Tensor<2> {
    let n = gather.from.starts.len() - 1;
    assert_eq!(rows.dims()[0], n, "rows of a tensor and of a gather");
    Tensor::from_dispatch(Dispatch::gathered(rows.into_dispatch(), gather.clone()))
}
