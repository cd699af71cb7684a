//! Rows of six numbers are read as plain code reads them, for every raw value.

// A failing test may panic.
#![allow(clippy::indexing_slicing)]

use cobotwire_simd::Six;

/// The bytes before the first row, so that rows start at odd places.
const BEFORE: usize = 3;

/// The factor `1 / divide` in two parts, as the core makes it.
fn factor(divide: f64) -> (f64, f64) {
    let high = f64::from_bits((1.0 / divide).to_bits() & !((1 << 17) - 1));
    (high, (1.0 - high * divide) / divide)
}

fn six(bias: i32, bounds: (i32, i32), divide: [f64; 8]) -> Six {
    Six {
        bias: [bias; 8],
        least: [bounds.0; 8],
        // The last two are for the bytes after a row, which must not matter.
        span: std::array::from_fn(|place| match place {
            0..6 => (bounds.1 - bounds.0).cast_unsigned(),
            _ => u32::MAX,
        }),
        high: divide.map(|divide| factor(divide).0),
        low: divide.map(|divide| factor(divide).1),
    }
}

/// Return a block with every pair of bytes at every position of a row, and where its rows start.
fn every_word() -> (Vec<u8>, Vec<usize>) {
    let mut block = vec![0; BEFORE];
    let rows: Vec<usize> = (0..1 << 16).map(|row| BEFORE + 12 * row).collect();
    for word in 0..=u16::MAX {
        for place in 0..6 {
            block.extend(word.wrapping_add(place * 10_007).to_be_bytes());
        }
    }
    block.extend([0xFF; 16]);
    (block, rows)
}

fn raws(block: &[u8], rows: &[usize], bias: i32) -> Vec<i32> {
    let words = |row: &usize| block[*row..*row + 12].as_chunks::<2>().0.to_vec();
    let raw = |pair| ((i32::from(u16::from_be_bytes(pair)) + bias) & 0xFFFF) - bias;
    rows.iter().flat_map(words).map(raw).collect()
}

#[test]
fn every_raw_value_becomes_the_quotient_that_a_division_gives() {
    let (block, rows) = every_word();
    let divide = [10.0, 10.0, 10.0, 100.0, 100.0, 100.0, 1.0, 1.0];
    for (bias, bounds) in [(0x8000, (-0x8000, 0x7FFF)), (0, (0, 0xFFFF))] {
        let mut out = vec![0.5];
        let rules = six(bias, bounds, divide);
        let Some(all) = rules.append_physical(&mut out, &block, rows.iter().copied()) else {
            return; // this processor runs the plain code
        };
        assert!(all);
        let divided = raws(&block, &rows, bias).into_iter().enumerate();
        let divided = divided.map(|(index, raw)| f64::from(raw) / divide[index % 6]);
        let bits = |all: &[f64]| all.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(out[0], 0.5);
        assert_eq!(bits(&out[1..]), bits(&divided.collect::<Vec<_>>()));
    }
}

#[test]
fn every_raw_value_is_appended_unchanged() {
    let (block, rows) = every_word();
    let rules = six(0x8000, (-0x8000, 0x7FFF), [1.0; 8]);
    let mut out = vec![];
    if let Some(all) = rules.append_raw(&mut out, &block, rows.iter().copied()) {
        assert!(all);
        let raws = raws(&block, &rows, 0x8000);
        assert!(out.iter().map(|raw| i32::from(*raw)).eq(raws));
    }
}

#[test]
fn every_raw_value_is_checked_against_its_bounds() {
    let limits = [
        (0x8000, -0x8000, 0x7FFF),
        (0x8000, -17_500, 17_500),
        (0x8000, -0x8000, -1),
        (0x8000, 5, 5),
        (0, 0, 0x7FFF),
        (0, 1000, 30_000),
    ];
    for (bias, least, most) in limits {
        let rules = six(bias, (least, most), [1.0; 8]);
        for word in 0..=u16::MAX {
            let block = word.to_be_bytes().repeat(8);
            let raw = ((i32::from(word) + bias) & 0xFFFF) - bias;
            let fits = (least..=most).contains(&raw);
            let (mut raws, mut reals) = (vec![], vec![]);
            let all = rules.append_raw(&mut raws, &block, [0].into_iter());
            if let Some(all) = all {
                assert_eq!((all, raws.len()), (fits, 6 * usize::from(fits)));
                assert!(raws.iter().all(|each| i32::from(*each) == raw));
                let all = rules.append_physical(&mut reals, &block, [0].into_iter());
                assert_eq!((all, reals.len()), (Some(fits), raws.len()));
            }
        }
    }
}

#[test]
fn bounds_outside_of_two_bytes_are_left_to_plain_code() {
    for (bias, bounds) in [(0, (-1, 5)), (0x8000, (0, 0x8000)), (0, (5, 0x1_0000))] {
        let rules = six(bias, bounds, [1.0; 8]);
        let rows = std::iter::once(0);
        assert_eq!(rules.append_raw(&mut vec![], &[0; 32], rows), None);
    }
}

#[test]
fn one_value_out_of_bounds_appends_nothing() {
    let mut block = [0, 50].repeat(40);
    block.extend([0; 16]);
    let rows = [0, 12, 24, 36];
    let rules = six(0x8000, (-100, 100), [1.0; 8]);
    let mut out = vec![7];
    if rules
        .append_raw(&mut out, &block, rows.into_iter())
        .is_none()
    {
        return; // this processor runs the plain code
    }
    assert_eq!(out.len(), 1 + 24);
    for place in 0..24 {
        for (bad, good) in [((0, 101), (0, 100)), ((0xFF, 0x9B), (0xFF, 0x9C))] {
            for ((high, low), fits) in [(bad, false), (good, true)] {
                let mut block = block.clone();
                (block[2 * place], block[2 * place + 1]) = (high, low);
                let mut out = vec![7];
                let all = rules.append_raw(&mut out, &block, rows.into_iter());
                assert_eq!((all, out.len()), (Some(fits), if fits { 25 } else { 1 }));
                let mut out = vec![0.5];
                let all = rules.append_physical(&mut out, &block, rows.into_iter());
                assert_eq!((all, out.len()), (Some(fits), if fits { 25 } else { 1 }));
            }
        }
    }
}

#[test]
fn row_beyond_the_block_appends_nothing() {
    let block = [0; 40];
    let rules = six(0x8000, (-100, 100), [1.0; 8]);
    for start in [25, 39, 40, 1000, usize::MAX] {
        let mut out = vec![];
        if let Some(all) = rules.append_raw(&mut out, &block, [0, start].into_iter()) {
            assert!(!all && out.is_empty());
        }
    }
}
