//! Reads contiguous bytes with several threads, with the results of one.
//!
//! The bytes are cut into pieces, which are assigned to the threads in rotation. A piece starts at
//! a guess: a position after its cut at which a frame seems to start. Each thread reads its piece
//! into its own memory, and then waits until the scan of the stream has reached the piece. A scan
//! has no state: if the scan of the stream reaches exactly the guessed position, it would find the
//! same frames as the thread. If not, the thread reads the piece again, from the position at which
//! the scan stands. Then it appends what it found to the results, and passes the turn to the thread
//! with the next piece. So the results are in the order of the stream, even if a guess was wrong.

use std::hint::spin_loop;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::{self, Builder, available_parallelism};

use super::block::BLOCK;
use super::search::{Collect, Search};
use crate::rules::{Rules, Verdict};
use cobotwire_simd::SEEN;

/// The number of bytes that a guess may examine.
const GUESSING: usize = 512;
/// How often a thread checks whether its turn has come before it sleeps. To wake a sleeping thread
/// takes both threads longer than these checks.
const CHECKS: usize = 5_000;
/// More threads do not help, since the threads append their results one after another.
const MOST: usize = 16;
/// For less input, starting threads costs more than it saves.
const WORTH: usize = 1 << 23;
/// The bytes between two cuts: two blocks. The longer the columns of a piece are, the faster they
/// are appended, as long as they fit into the cache of a core until then.
const STRIDE: usize = 2 * BLOCK - GUESSING;

/// The number of threads that read, and the pieces that they read.
#[derive(Clone, Copy, Debug)]
pub struct Workers {
    count: usize,
    /// The bytes between two cuts; `None`: the default, and small input is not cut.
    stride: Option<usize>,
}

impl Workers {
    /// Read in the calling thread only.
    pub const ONE: Self = Self::new(1);

    /// Read large input with at most this number of threads, including the calling one. The number
    /// of processors and 16 are upper limits.
    #[must_use]
    pub const fn new(count: usize) -> Self {
        Self {
            count,
            stride: None,
        }
    }

    /// Return whether several threads may read.
    #[must_use]
    pub fn are_several(self) -> bool {
        self.count > 1
    }

    /// Cut input of any size every `stride` bytes, to test many cuts with few bytes on any machine.
    #[must_use]
    pub fn cutting_every(self, stride: usize) -> Self {
        Self {
            stride: Some(stride.max(1)),
            ..self
        }
    }

    /// Return the number of threads for input of this size, which is cut into this number of
    /// pieces.
    fn for_input(self, size: usize, pieces: usize) -> usize {
        let count = self.count.min(MOST).min(pieces);
        match self.stride {
            Some(_) => count,
            None if count < 2 || size < WORTH => 1,
            None => count.min(available_parallelism().map_or(1, usize::from)),
        }
    }
}

/// Collects what a search finds, also in several threads.
pub(crate) trait Share: Collect + Send {
    /// Return an empty collector for a thread.
    fn part(&self) -> Self;

    /// Append what a thread has collected, and leave its collector empty, with its memory.
    fn append(&mut self, part: &mut Self);

    /// Forget what was collected.
    fn clear(&mut self);
}

/// The bytes to read, and where they are cut.
#[derive(Clone, Copy)]
struct Cuts<'a> {
    data: &'a [u8],
    /// The position of the data in the stream.
    offset: u64,
    stride: usize,
    pieces: usize,
}

impl<'a> Cuts<'a> {
    /// Cut `data`. After the last piece there are enough bytes to validate each position in it.
    fn new(workers: Workers, rules: &Rules, offset: u64, data: &'a [u8]) -> Self {
        let rest = GUESSING + rules.longest().max(SEEN);
        let stride = workers.stride.unwrap_or(STRIDE);
        Self {
            data,
            offset,
            stride,
            pieces: data.len().saturating_sub(rest) / stride,
        }
    }

    /// Return where a piece starts: at the first position after its cut where a frame seems to
    /// start.
    fn start(&self, piece: usize, rules: &Rules) -> usize {
        let cut = piece * self.stride;
        let framed = |at: &usize| {
            let rest = self.data.get(*at..).unwrap_or_default();
            matches!(rules.validate(rest), Verdict::Frame(_))
        };
        let end = cut + GUESSING;
        match piece {
            0 => 0,
            _ => (cut..end).find(framed).unwrap_or(end),
        }
    }
}

/// What the threads pass on to each other: the search of the stream, and its results.
struct Turn<'a, C> {
    search: &'a mut Search,
    collect: &'a mut C,
    /// The position at which the search stands.
    at: &'a mut usize,
}

/// A thread's position in the ring of threads that read in rotation.
struct Seat<'a, C> {
    index: usize,
    count: usize,
    turns: Receiver<Turn<'a, C>>,
    next: Sender<Turn<'a, C>>,
}

impl<'a, C> Seat<'a, C> {
    /// Return a ring of seats; the first one has the turn.
    fn ring(count: usize, turn: Turn<'a, C>) -> Vec<Self> {
        let (mut next, turns): (Vec<_>, Vec<_>) = (0..count).map(|_| channel()).unzip();
        if let Some(first) = next.first() {
            // Sending fails only without the receiver, which is in `turns`.
            let _ = first.send(turn);
        }
        next.rotate_left(1);
        let seat = |(index, (turns, next))| Self {
            index,
            count,
            turns,
            next,
        };
        turns.into_iter().zip(next).enumerate().map(seat).collect()
    }

    /// Wait for the turn; `None`: another thread has panicked.
    fn turn(&self) -> Option<Turn<'a, C>> {
        for _ in 0..CHECKS {
            match self.turns.try_recv() {
                Ok(turn) => return Some(turn),
                Err(TryRecvError::Empty) => spin_loop(),
                Err(TryRecvError::Disconnected) => return None,
            }
        }
        self.turns.recv().ok()
    }
}

/// Read most of `data`, which is at `offset` in the stream; return the position at which the search
/// stands then. It stays at the start if the input is too small for several threads, or if no
/// thread can be started.
pub(crate) fn read<C: Share>(
    workers: Workers,
    search: &mut Search,
    offset: u64,
    data: &[u8],
    collect: &mut C,
) -> usize {
    let cuts = Cuts::new(workers, &search.rules, offset, data);
    let count = workers.for_input(data.len(), cuts.pieces);
    let mut at = 0;
    if count < 2 {
        return at;
    }
    let reader = || Reader {
        search: Search::new(search.rules.clone()),
        part: collect.part(),
    };
    let (mut mine, others) = (reader(), (1..count).map(|_| reader()).collect::<Vec<_>>());
    thread::scope(|scope| {
        let mut seats = Vec::with_capacity(count);
        for mut reader in others {
            let (give, seat) = channel();
            let work = move || seat.recv().map(|seat| reader.read(cuts, &seat));
            // The system may refuse a thread; then there are fewer.
            if Builder::new().spawn_scoped(scope, work).is_ok() {
                seats.push(give);
            }
        }
        if seats.is_empty() {
            return;
        }
        let turn = Turn {
            search,
            collect,
            at: &mut at,
        };
        let mut ring = Seat::ring(1 + seats.len(), turn).into_iter();
        let first = ring.next();
        for (give, seat) in seats.into_iter().zip(ring) {
            // Sending fails only if the thread has panicked; then the others end too.
            let _ = give.send(seat);
        }
        if let Some(seat) = first {
            mine.read(cuts, &seat);
        }
    });
    at
}

/// A thread's memory.
struct Reader<C> {
    search: Search,
    part: C,
}

impl<C: Share> Reader<C> {
    /// Read every piece that is assigned to this thread.
    fn read(&mut self, cuts: Cuts<'_>, seat: &Seat<'_, C>) {
        for piece in (seat.index..cuts.pieces).step_by(seat.count) {
            let start = cuts.start(piece, &self.search.rules);
            let stop = cuts.start(piece + 1, &self.search.rules);
            let mut end = self.piece(cuts, start, stop);
            let Some(turn) = seat.turn() else {
                return;
            };
            if *turn.at != start {
                self.search.clear();
                self.part.clear();
                end = self.piece(cuts, *turn.at, stop);
            }
            turn.search.append(&mut self.search);
            turn.collect.append(&mut self.part);
            *turn.at = end;
            if seat.next.send(turn).is_err() {
                return;
            }
        }
    }

    /// Read the bytes from `start` to `stop`; return the position at which the search stands then.
    fn piece(&mut self, cuts: Cuts<'_>, start: usize, stop: usize) -> usize {
        let Self { search, part } = self;
        let rest = cuts.data.get(start..).unwrap_or_default();
        let left = stop.saturating_sub(start);
        start + search.through(cuts.offset + start as u64, rest, left, false, part)
    }
}
