//! Reads what a file states about its robot.

use alloc::vec::Vec;

use crate::Outcome;
use crate::json::Record;

/// One link of an arm, by standard Denavit-Hartenberg parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// What is added to the angle of the joint, in degrees.
    pub offset: f64,
    /// The twist, in degrees.
    pub alpha: f64,
    /// The length, in millimetres.
    pub a: f64,
    /// The offset along the axis, in millimetres.
    pub d: f64,
    /// The joints that turn the link, counted from 0, and how far for each degree of theirs;
    /// `None`: the joint of the same number.
    pub turned_by: Option<Vec<(usize, f64)>>,
}

/// Return a link of the arm.
pub(crate) fn link(record: Record<'_>) -> Outcome<Link> {
    let share = |each: Record<'_>| {
        let joint: usize = each.within("joint", 1..=255)?;
        Ok((joint - 1, each.real("share")?))
    };
    let shares = record.some("turned_by").map(Record::items).transpose()?;
    let shares = shares.map(|all| all.into_iter().map(share).collect());
    Ok(Link {
        offset: record.real("offset")?,
        alpha: record.real("alpha")?,
        a: record.real("a")?,
        d: record.real("d")?,
        turned_by: shares.transpose()?,
    })
}
