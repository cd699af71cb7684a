//! One direction of one interface: joins its packets, decodes them in bulk, and keeps times.

use super::clock::Clock;
use super::packet::{Packet, PacketDirection};
use super::pieces::Piece;
use crate::bulk::{ColumnReader, Columns, Workspace};

use crate::tally::Tally;

/// Bytes are decoded together as soon as there are this many: a few blocks of bulk reading, which
/// stay in the processor's cache.
const ENOUGH: usize = 1 << 18;

/// The times of a segment of a stream, in nanoseconds since 1970.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// For each entry of [`Columns::rows`], the time of the first byte of each message.
    pub rows: Vec<Vec<i64>>,
    /// The times of the rejected frames.
    pub rejected: Vec<i64>,
    /// The time of the first byte of each span of noise.
    pub noise: Vec<i64>,
}

/// What was found in one stream since the last batch.
#[derive(Debug)]
pub struct StreamBatch {
    /// The index of the interface in the file.
    pub interface: usize,
    /// The direction of the packets.
    pub direction: PacketDirection,
    /// The messages.
    pub columns: Columns,
    /// Their times.
    pub times: Times,
    /// The counts since the start of the stream.
    pub tally: Tally,
}

/// One direction of one interface.
pub(crate) struct Stream {
    pub(crate) interface: usize,
    pub(crate) direction: PacketDirection,
    reader: ColumnReader,
    /// Bytes that were not decoded yet.
    gathered: Vec<u8>,
    /// The number of bytes in all packets.
    size: u64,
    clock: Clock,
    /// The start and the time of the noise that may continue; the clock may have forgotten them.
    noise: Option<(u64, i64)>,
    times: Times,
    /// The time of the last piece.
    pub(crate) last: i64,
    /// Whether bytes came since the last flush.
    pub(crate) waiting: bool,
}

impl Stream {
    pub(crate) fn new(interface: usize, direction: PacketDirection, reader: ColumnReader) -> Self {
        Self {
            interface,
            direction,
            reader,
            gathered: Vec::new(),
            size: 0,
            clock: Clock::default(),
            noise: None,
            times: Times::default(),
            last: 0,
            waiting: false,
        }
    }

    /// Add the next packet; all of its bytes arrived at its time.
    #[inline]
    pub(crate) fn add(&mut self, packet: &Packet<'_>, work: &mut Workspace) {
        self.clock.add(self.size, packet.time);
        self.last = packet.time;
        self.size += packet.data.len() as u64;
        self.gather(packet.data, work);
    }

    /// Add the next packet, which arrived in pieces.
    pub(crate) fn add_pieces(
        &mut self,
        packet: &Packet<'_>,
        pieces: &[Piece],
        work: &mut Workspace,
    ) {
        for piece in pieces {
            self.last = piece.time;
            self.clock.add(self.size, piece.time);
            self.size += piece.size;
        }
        self.gather(packet.data, work);
    }

    #[inline]
    fn gather(&mut self, data: &[u8], work: &mut Workspace) {
        self.gathered.extend_from_slice(data);
        self.waiting = true;
        if self.gathered.len() >= ENOUGH {
            self.decode(work);
        }
    }

    /// Stop waiting for more bytes.
    pub(crate) fn flush(&mut self, work: &mut Workspace) {
        self.decode(work);
        self.reader.exchange(work);
        self.reader.flush();
        self.reader.exchange(work);
        self.stamp();
        self.waiting = false;
    }

    /// Decode the gathered bytes.
    pub(crate) fn decode(&mut self, work: &mut Workspace) {
        if self.gathered.is_empty() {
            return;
        }
        self.reader.exchange(work);
        self.reader.feed(&self.gathered);
        self.reader.exchange(work);
        self.gathered.clear();
        self.stamp();
    }

    /// Decode the gathered bytes, and free their memory.
    pub(crate) fn empty(&mut self, work: &mut Workspace) {
        self.decode(work);
        self.gathered = Vec::new();
    }

    /// Look up the times of everything found since the last call.
    fn stamp(&mut self) {
        let found = self.reader.found();
        let Times {
            rows,
            rejected,
            noise,
        } = &mut self.times;
        rows.resize_with(found.rows.len(), Vec::new);
        for (rows, times) in found.rows.iter().zip(rows) {
            stamp(&self.clock, &rows.offsets, times);
        }
        stamp(&self.clock, found.rejected, rejected);
        let new = found.noise.get(noise.len()..).unwrap_or_default();
        match (new.split_first(), self.noise) {
            (Some((first, rest)), Some((start, time))) if *first == start => {
                noise.push(time);
                self.clock.stamp(rest, noise);
            }
            _ => self.clock.stamp(new, noise),
        }
        if found.open_noise != self.noise.map(|(start, _)| start) {
            let time = |start| (start, self.clock.time_of(start));
            self.noise = found.open_noise.map(time);
        }
        let pending = self.reader.pending() as u64;
        self.clock.forget_before(self.size - pending);
    }

    /// Return everything found since the last call.
    pub(crate) fn take(&mut self) -> StreamBatch {
        let columns = self.reader.take();
        let mut times = std::mem::take(&mut self.times);
        times.rows.resize_with(columns.rows.len(), Vec::new);
        StreamBatch {
            interface: self.interface,
            direction: self.direction,
            columns,
            times,
            tally: self.reader.tally().clone(),
        }
    }
}

/// Append the times of those offsets that have none yet.
fn stamp(clock: &Clock, offsets: &[u64], times: &mut Vec<i64>) {
    let new = offsets.get(times.len()..).unwrap_or_default();
    if !new.is_empty() {
        clock.stamp(new, times);
    }
}
