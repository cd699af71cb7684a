//! The bytes that end a frame.

/// The kinds of check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// Always this byte.
    Footer(u8),
    /// A CRC-16/MODBUS over everything before it, high byte first.
    Crc16Modbus,
    /// The low byte of the sum of CMD and DATA.
    Sum,
}

impl Check {
    /// Return the number of bytes of the check.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::Footer(_) | Self::Sum => 1,
            Self::Crc16Modbus => 2,
        }
    }

    /// Return whether the check of a frame is right; its CMD is at `start`.
    #[inline]
    pub(crate) fn holds(self, frame: &[u8], start: usize) -> bool {
        match self {
            Self::Footer(footer) => frame.last() == Some(&footer),
            Self::Crc16Modbus => crc_holds(frame),
            Self::Sum => sum_holds(frame, start),
        }
    }

    /// Append the check to a frame; its CMD is at `start`.
    pub(crate) fn end(self, frame: &mut Vec<u8>, start: usize) {
        match self {
            Self::Footer(footer) => frame.push(footer),
            Self::Crc16Modbus => frame.extend(crc16_modbus(frame).to_be_bytes()),
            Self::Sum => frame.push(sum(frame, start)),
        }
    }
}

#[inline(never)]
fn crc_holds(frame: &[u8]) -> bool {
    frame
        .split_last_chunk()
        .is_some_and(|(body, end)| crc16_modbus(body).to_be_bytes() == *end)
}

#[inline(never)]
fn sum_holds(frame: &[u8], start: usize) -> bool {
    frame
        .split_last()
        .is_some_and(|(end, body)| sum(body, start) == *end)
}

fn sum(body: &[u8], start: usize) -> u8 {
    let counted = body.get(start..).unwrap_or_default().iter();
    counted.fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// CRC-16/MODBUS: polynomial 0x8005 reflected, start FFFF; 4B37 for `123456789`.
#[must_use]
pub fn crc16_modbus(data: &[u8]) -> u16 {
    data.iter().fold(0xFFFF, |crc, byte| {
        let [low, _] = (crc ^ u16::from(*byte)).to_le_bytes();
        let step = STEPS.get(usize::from(low)).copied().unwrap_or_default();
        crc >> 8 ^ step
    })
}

/// The effect of each byte on a CRC: the table is eight times as fast as a loop over bits.
const STEPS: [u16; 256] = steps();

// This runs in the compiler, where an index out of bounds is an error.
#[allow(clippy::indexing_slicing)]
const fn steps() -> [u16; 256] {
    let mut steps = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = byte as u16;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xA001
            } else {
                crc >> 1
            };
            bit += 1;
        }
        steps[byte] = crc;
        byte += 1;
    }
    steps
}
