//! Reads a recording that arrives in chunks.

use std::sync::Arc;

use super::blocks::{Block, Cutter, Step};
use super::damage::Damage;
use super::interface::Interface;
use super::packet::{Packet, PacketDirection};
use super::parser::Parser;
use super::pieces::{self, Piece};
use super::stream::{Stream, StreamBatch};
use crate::bulk::{ColumnReader, Numbers, Plans, Workspace};
use crate::direction::{Direction, Listening};
use crate::table::Table;

/// After this many nanoseconds without a byte, a direction stops waiting for the rest of a frame.
const IDLE: i64 = 500_000_000;
/// The most bytes that all streams together keep without decoding them.
const MOST_GATHERED: usize = 4 << 20;
/// The memory of a larger incomplete block is freed when the block is complete.
const LARGE_BLOCK: usize = 1 << 20;

/// How to decode the frames of an interface.
pub struct Decoder {
    /// The table of its edition.
    pub table: Arc<Table>,
    /// The plans of that table for the directions.
    pub plans: Arc<Plans>,
}

/// Where a reader gets decoders from.
pub trait Decoders {
    /// Return how to decode the messages of an interface in these directions. The reader stops if
    /// there is no decoder.
    fn decoder(&mut self, interface: &Interface, listening: Listening) -> Option<Decoder>;
}

/// Reads a recording into columns. Between two calls it keeps an incomplete block, and the
/// unfinished frames and noise of each stream.
pub struct CaptureReader {
    listening: Listening,
    numbers: Numbers,
    cutter: Cutter,
    parser: Parser,
    /// The start of a block that is not complete.
    kept: Vec<u8>,
    size: u64,
    truncated_at: Option<u64>,
    damage: Option<Damage>,
    ended: bool,
    streams: Streams,
    /// The pieces of the current packet.
    pieces: Vec<Piece>,
}

impl CaptureReader {
    /// Return a reader for a new file. Packets of unknown direction hold messages of `listening`.
    #[must_use]
    pub fn new(listening: Listening, numbers: Numbers) -> Self {
        Self {
            listening,
            numbers,
            cutter: Cutter::default(),
            parser: Parser::default(),
            kept: Vec::new(),
            size: 0,
            truncated_at: None,
            damage: None,
            ended: false,
            streams: Streams::default(),
            pieces: Vec::new(),
        }
    }

    /// Feed the next bytes of the file; [`CaptureReader::take`] returns what more bytes cannot
    /// change. After damage or the end, more bytes are ignored.
    pub fn feed(&mut self, chunk: &[u8], decoders: &mut impl Decoders) {
        if self.ended {
            return;
        }
        self.size += chunk.len() as u64;
        let result = self.complete(chunk, decoders);
        let result = result.and_then(|rest| self.blocks(rest, decoders));
        if let Err(stop) = result {
            self.ended = true;
            self.damage = stop;
        }
    }

    /// End the file, and stop waiting for more bytes.
    pub fn finish(&mut self) {
        if !self.ended && !self.kept.is_empty() {
            self.truncated_at = Some(self.cutter.offset);
        }
        self.ended = true;
        self.streams.finish();
    }

    /// Return what was found in each stream since the last call, in the order of their first
    /// packets.
    pub fn take(&mut self) -> Vec<StreamBatch> {
        self.streams.decode_all();
        self.streams.all.iter_mut().map(Stream::take).collect()
    }

    /// Return the interfaces that the blocks so far describe.
    #[must_use]
    pub fn interfaces(&self) -> &[Interface] {
        &self.parser.interfaces
    }

    /// Return the name of the program that wrote the file.
    #[must_use]
    pub fn application(&self) -> &[u8] {
        &self.parser.application
    }

    /// Return whether each interface has its statistics, which the recorder writes at the end.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.parser.finished()
    }

    /// Return the position of the incomplete block at the end of the file.
    #[must_use]
    pub fn truncated_at(&self) -> Option<u64> {
        self.truncated_at
    }

    /// Return why the file cannot be read to its end.
    #[must_use]
    pub fn damage(&self) -> Option<Damage> {
        self.damage
    }

    /// Return the number of bytes fed.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Complete the block that the last chunk began; return the bytes after it.
    fn complete<'a>(
        &mut self,
        chunk: &'a [u8],
        decoders: &mut impl Decoders,
    ) -> Result<&'a [u8], Option<Damage>> {
        let mut kept = std::mem::take(&mut self.kept);
        let mut rest = chunk;
        while !kept.is_empty() {
            match self.cutter.next(&kept)? {
                Step::Needs(size) => {
                    let missing = size.saturating_sub(kept.len()).min(rest.len());
                    let (more, after) = rest.split_at(missing);
                    kept.extend_from_slice(more);
                    rest = after;
                    if missing == 0 {
                        break;
                    }
                }
                Step::Block(block, size) => {
                    self.block(block, size, decoders)?;
                    kept.clear();
                }
            }
        }
        if kept.capacity() <= LARGE_BLOCK || !kept.is_empty() {
            self.kept = kept;
        }
        Ok(rest)
    }

    /// Take the complete blocks of `rest`; keep what is left.
    fn blocks(
        &mut self,
        mut rest: &[u8],
        decoders: &mut impl Decoders,
    ) -> Result<(), Option<Damage>> {
        while !rest.is_empty() {
            match self.cutter.next(rest)? {
                Step::Needs(_) => {
                    self.kept.extend_from_slice(rest);
                    break;
                }
                Step::Block(block, size) => {
                    self.block(block, size, decoders)?;
                    rest = rest.get(size..).unwrap_or_default();
                }
            }
        }
        Ok(())
    }

    #[inline]
    fn block(
        &mut self,
        block: Block<'_>,
        size: usize,
        decoders: &mut impl Decoders,
    ) -> Result<(), Option<Damage>> {
        let at = |fault| {
            Some(Damage {
                offset: block.offset,
                fault,
            })
        };
        if let Some(packet) = self.parser.take(block).map_err(at)? {
            pieces::read(&packet, &mut self.pieces).map_err(at)?;
            let index = self.streams.of(packet.interface, packet.direction);
            let index = match index {
                Some(index) => index,
                None => self.open(&packet, decoders).ok_or(None)?,
            };
            self.streams.add(index, &packet, &self.pieces);
        }
        self.cutter.pass(size);
        Ok(())
    }

    /// Open the stream that a packet begins; return its index.
    #[cold]
    fn open(&mut self, packet: &Packet<'_>, decoders: &mut impl Decoders) -> Option<usize> {
        let listening = match packet.direction {
            PacketDirection::Sent => Listening::To(Direction::Request),
            PacketDirection::Received => Listening::To(Direction::Reply),
            PacketDirection::Unknown => self.listening,
        };
        let interface = self.parser.interfaces.get(packet.interface)?;
        let Decoder { table, plans } = decoders.decoder(interface, listening)?;
        let reader = ColumnReader::new(table, plans, self.numbers, None);
        let stream = Stream::new(packet.interface, packet.direction, reader);
        Some(self.streams.push(stream))
    }
}

/// The streams of a file.
#[derive(Default)]
struct Streams {
    all: Vec<Stream>,
    /// For each interface and direction, one more than the index of its stream; 0: it has none.
    indexes: Vec<[usize; 3]>,
    work: Workspace,
    /// The bytes that were gathered since all streams were decoded.
    gathered: usize,
    /// No waiting stream received its last byte earlier than this.
    oldest: Option<i64>,
}

impl Streams {
    #[inline]
    fn of(&self, interface: usize, direction: PacketDirection) -> Option<usize> {
        let index = self.indexes.get(interface)?.get(direction as usize)?;
        index.checked_sub(1)
    }

    fn push(&mut self, stream: Stream) -> usize {
        let (interface, direction) = (stream.interface, stream.direction as usize);
        if self.indexes.len() <= interface {
            self.indexes.resize(interface + 1, [0; 3]);
        }
        self.all.push(stream);
        let entry = self.indexes.get_mut(interface);
        if let Some(index) = entry.and_then(|entry| entry.get_mut(direction)) {
            *index = self.all.len();
        }
        self.all.len() - 1
    }

    #[inline]
    fn add(&mut self, index: usize, packet: &Packet<'_>, pieces: &[Piece]) {
        self.flush_idle(packet.time);
        let Some(stream) = self.all.get_mut(index) else {
            return;
        };
        if pieces.is_empty() {
            stream.add(packet, &mut self.work);
        } else {
            stream.add_pieces(packet, pieces, &mut self.work);
        }
        self.oldest = Some(self.oldest.map_or(stream.last, |old| old.min(stream.last)));
        self.gathered += packet.data.len();
        if self.gathered >= MOST_GATHERED {
            self.decode_all();
        }
    }

    /// Flush the waiting streams that have been idle for [`IDLE`] at `time`.
    #[inline]
    fn flush_idle(&mut self, time: i64) {
        if let (Some(before), Some(oldest)) = (time.checked_sub(IDLE), self.oldest)
            && before >= oldest
        {
            self.flush_silent(before);
        }
    }

    /// Flush the waiting streams whose last byte came at `before` or earlier.
    #[inline(never)]
    fn flush_silent(&mut self, before: i64) {
        self.oldest = None;
        for stream in self.all.iter_mut().filter(|stream| stream.waiting) {
            if stream.last <= before {
                stream.flush(&mut self.work);
            } else {
                let oldest = self.oldest.unwrap_or(stream.last);
                self.oldest = Some(oldest.min(stream.last));
            }
        }
    }

    fn decode_all(&mut self) {
        self.gathered = 0;
        for stream in &mut self.all {
            stream.empty(&mut self.work);
        }
    }

    fn finish(&mut self) {
        for stream in &mut self.all {
            stream.flush(&mut self.work);
        }
    }
}
