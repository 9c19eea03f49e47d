//! Numbers at whole places of faces.

use glam::I64Vec2;

use super::chart::Chart;

const NONE: u32 = u32::MAX;

/// One number per place of equal parity in the bounding box of each face.
pub(super) struct Table {
    boxes: Vec<Box>,
    values: Vec<u32>,
}

struct Box {
    low: I64Vec2,
    width: i64,
    first: usize,
}

impl Table {
    pub fn new(chart: &Chart) -> Self {
        let mut n = 0;
        let mut boxes = Vec::with_capacity(chart.corners.len());
        for face in 0..chart.corners.len() {
            let [low, high] = chart.bounds(face).map(|p| p.map(halved));
            let size = high - low + 1;
            boxes.push(Box {
                low,
                width: size.x,
                first: n,
            });
            n += (size.x * size.y) as usize;
        }
        Self {
            boxes,
            values: vec![NONE; n],
        }
    }

    fn place(&self, face: usize, point: I64Vec2) -> usize {
        let own = &self.boxes[face];
        let at = point.map(halved) - own.low;
        own.first + (at.y * own.width + at.x) as usize
    }

    pub fn set(&mut self, face: usize, point: I64Vec2, value: u32) {
        let place = self.place(face, point);
        self.values[place] = value;
    }

    pub fn get(&self, face: usize, point: I64Vec2) -> Option<u32> {
        let value = self.values[self.place(face, point)];
        (value != NONE).then_some(value)
    }

    pub fn get_or_set(&mut self, face: usize, point: I64Vec2, new: u32) -> u32 {
        let place = self.place(face, point);
        if self.values[place] == NONE {
            self.values[place] = new;
        }
        self.values[place]
    }
}

fn halved(x: i64) -> i64 {
    x.div_euclid(2)
}
