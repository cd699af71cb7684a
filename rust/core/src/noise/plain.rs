//! Noise in which nothing else is found: NULs, a wrong baud rate, or unknown bytes.

use super::{Cluster, Kind, Verdict};

/// Unrecognised bytes are reported in pieces of this size.
pub(super) const PIECE: usize = 256;
/// The largest piece of a run of NULs.
pub(super) const NULS: usize = 4096;
/// At least this many NULs in a row are a finding of their own, also inside other noise.
const FEWEST_NULS: usize = 4;
/// At least this many NULs in a row mean a reboot, which Python describes.
const REBOOT_NULS: usize = 64;
/// Fewer bytes do not prove a wrong baud rate.
const FEWEST_GARBAGE: usize = 3;
/// Bytes below this value may be small numbers, so they are no sign of a wrong baud rate.
const LARGE: u8 = 0x40;

/// Recognise the run of NULs at `at`.
pub(super) fn nuls(cluster: &Cluster<'_>, at: usize) -> Verdict {
    let rest = cluster.rest(at);
    let run = rest.iter().take(NULS).take_while(|byte| **byte == 0);
    let count = run.count();
    (count >= FEWEST_NULS).then_some((run_of(count), at + count))
}

fn run_of(nuls: usize) -> Kind {
    if nuls < REBOOT_NULS {
        Kind::Nuls
    } else {
        Kind::Other
    }
}

/// Return the class of plain bytes.
pub(super) fn classify(cluster: &Cluster<'_>, start: usize, end: usize) -> Kind {
    let data = cluster.data.get(start..end).unwrap_or_default();
    if data.iter().all(|byte| *byte == 0) {
        return run_of(data.len());
    }
    let (mut fitting, mut large) = (0, 0);
    for byte in data {
        let fits = usize::from(fits(*byte));
        fitting += fits;
        large += if *byte >= LARGE { fits } else { 0 };
    }
    // Three quarters of the bytes fit, and half are fitting bytes that are not small numbers.
    let stretched = 4 * fitting >= 3 * data.len() && 2 * large >= data.len();
    if data.len() >= FEWEST_GARBAGE && stretched {
        Kind::Garbage
    } else {
        Kind::Unrecognised
    }
}

/// Return how many bytes look as if they were sent at a lower rate.
pub(crate) fn fitting(data: &[u8]) -> usize {
    data.iter().filter(|byte| fits(**byte)).count()
}

fn fits(byte: u8) -> bool {
    FITS.get(usize::from(byte)) == Some(&true)
}

/// Whether each byte is even, not zero, and its ones are consecutive.
static FITS: [bool; 256] = {
    let mut all = [false; 256];
    let mut ones = 1;
    while ones < 0x80 {
        let mut byte = ones << 1;
        while byte < 0x100 {
            #[allow(clippy::indexing_slicing)] // in bounds: the loop ends there
            {
                all[byte] = true;
            }
            byte <<= 1;
        }
        ones = ones << 1 | 1;
    }
    all
};
