//! Interprets blocks: sections, interfaces, packets and statistics.

use super::blocks::{Block, SECTION};
use super::body::Body;
use super::damage::Fault;
use super::interface::{Format, Interface};
use super::packet::{Packet, PacketDirection};

const INTERFACE: u32 = 1;
const OBSOLETE_PACKET: u32 = 2;
const SIMPLE_PACKET: u32 = 3;
const STATISTICS: u32 = 5;
const PACKET: u32 = 6;

const VERSION: u16 = 1;
const COMMENT: u16 = 1;
const PACKET_FLAGS: u16 = 2;
const APPLICATION: u16 = 4;
/// Reserved for private use: USER0 to USER15.
const USER_LINK_TYPES: std::ops::Range<u16> = 147..163;
/// A file with more interfaces is rejected, because each of them needs memory.
const MOST_INTERFACES: usize = 1024;

/// What the blocks so far have described.
#[derive(Default)]
pub(crate) struct Parser {
    pub(crate) application: Vec<u8>,
    /// The interfaces of all sections.
    pub(crate) interfaces: Vec<Interface>,
    /// For each of them, whether its statistics have been read.
    finished: Vec<bool>,
    /// The formats of the interfaces of this section, which are the last ones of `interfaces`.
    formats: Vec<Format>,
}

impl Parser {
    /// Return whether each interface has its statistics, which the recorder writes at the end.
    pub(crate) fn finished(&self) -> bool {
        !self.finished.is_empty() && self.finished.iter().all(|finished| *finished)
    }

    /// Interpret a block; return its packet if it is one.
    #[inline]
    pub(crate) fn take<'a>(&mut self, block: Block<'a>) -> Result<Option<Packet<'a>>, Fault> {
        let mut body = Body::new(block.body, block.order);
        match block.kind {
            PACKET => return self.packet(&mut body).map(Some),
            SECTION => self.section(&mut body)?,
            INTERFACE => self.interface(&mut body)?,
            STATISTICS => {
                let (number, _) = self.format(&mut body)?;
                if let Some(finished) = self.finished.get_mut(number) {
                    *finished = true;
                }
            }
            SIMPLE_PACKET | OBSOLETE_PACKET => return Err(Fault::NoTime),
            // Other blocks (names, secrets, private ones) are skipped.
            _ => {}
        }
        Ok(None)
    }

    fn section(&mut self, body: &mut Body<'_>) -> Result<(), Fault> {
        body.word()?;
        let major = body.half()?;
        body.half()?;
        body.data(8)?;
        if major != VERSION {
            return Err(Fault::Version(major));
        }
        // The indexes of interfaces start from 0 in each section.
        self.formats.clear();
        let mut application = &[][..];
        while let Some((code, value)) = body.option()? {
            if code == APPLICATION {
                application = value;
            }
        }
        self.application = application.to_vec();
        Ok(())
    }

    fn interface(&mut self, body: &mut Body<'_>) -> Result<(), Fault> {
        if self.interfaces.len() >= MOST_INTERFACES {
            return Err(Fault::TooManyInterfaces);
        }
        let (format, interface) = Format::read(body)?;
        self.formats.push(format);
        self.interfaces.push(interface);
        self.finished.push(false);
        Ok(())
    }

    /// Read the index of an interface in this section; return its index in the file, and its
    /// format.
    #[inline]
    fn format(&self, body: &mut Body<'_>) -> Result<(usize, Format), Fault> {
        let index = body.word()?;
        let local = usize::try_from(index).unwrap_or(usize::MAX);
        let format = self.formats.get(local).ok_or(Fault::NoInterface(index))?;
        Ok((self.interfaces.len() - self.formats.len() + local, *format))
    }

    #[inline]
    fn packet<'a>(&self, body: &mut Body<'a>) -> Result<Packet<'a>, Fault> {
        let (interface, format) = self.format(body)?;
        if !USER_LINK_TYPES.contains(&format.link_type) {
            return Err(Fault::LinkType(format.link_type));
        }
        let (high, low, size) = (body.word()?, body.word()?, body.word()?);
        body.word()?;
        let data = body.data(usize::try_from(size).unwrap_or(usize::MAX))?;
        let (mut flags, mut comment) = (&[][..], &[][..]);
        while let Some((code, value)) = body.option()? {
            match code {
                PACKET_FLAGS => flags = value,
                COMMENT => comment = value,
                _ => {}
            }
        }
        Ok(Packet {
            interface,
            direction: PacketDirection::of(body.order().lowest(flags)),
            time: format.nanoseconds(high, low)?,
            data,
            comment,
        })
    }
}
