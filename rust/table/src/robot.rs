//! Reads what a file states about its robot.

use alloc::vec::Vec;

use crate::json::{Node, Outcome, Record};

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

/// Return the lowest and the highest angle of each joint.
pub(crate) fn joint_limits(edition: Record<'_>) -> Outcome<Vec<(f64, f64)>> {
    let limits = edition.records("joint_limits")?.into_iter();
    let pair = |each: Record<'_>| Ok((each.need("low")?.real()?, each.need("high")?.real()?));
    limits.map(pair).collect()
}

/// Return the links of the arm; `None`: the file does not state them.
pub(crate) fn geometry(edition: Record<'_>) -> Outcome<Option<Vec<Link>>> {
    let Some(geometry) = edition.get("geometry") else {
        return Ok(None);
    };
    let links = geometry.record()?.records("links")?.into_iter();
    links.map(link).collect::<Outcome<_>>().map(Some)
}

fn link(record: Record<'_>) -> Outcome<Link> {
    let real = |name| record.need(name)?.real();
    let share = |each: Record<'_>| {
        let joint = usize::try_from(each.within("joint", 1..=255)?).unwrap_or(1);
        Ok((joint - 1, each.need("share")?.real()?))
    };
    Ok(Link {
        offset: real("offset")?,
        alpha: real("alpha")?,
        a: real("a")?,
        d: real("d")?,
        turned_by: match record.get("turned_by") {
            Some(shares) => Some(
                Node::records(shares)?
                    .into_iter()
                    .map(share)
                    .collect::<Outcome<_>>()?,
            ),
            None => None,
        },
    })
}
