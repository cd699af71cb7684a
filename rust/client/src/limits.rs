//! Limits for those who move an arm from afar: a highest speed, and a box for the end of the arm.

use std::collections::HashMap;
use std::sync::Arc;

use cobotwire_core::exchange::Safety;
use cobotwire_core::{Number, Table, Variant};
use cobotwire_table::{Command, Edition, Shown, bad_argument};

use crate::Error;
use crate::typed;

/// The lowest and the highest value that is allowed.
pub type Range = (f64, f64);

const AXES: [&str; 3] = ["x", "y", "z"];
/// States that decide what coordinates mean.
const FRAMES: [&str; 4] = ["tool", "world", "reference_frame", "end_type"];

/// How fast an arm may be sent, and where. What could exceed a limit is refused before a byte is
/// sent, and so are writes that stay. Nothing limits `stop`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// The highest speed in percent, 1..100.
    pub speed: Option<f64>,
    /// Ranges for x, y and z in millimetres: where the end may be sent by coordinates. Motions by
    /// angles of joints are refused then. The path to a target is not checked.
    pub workspace: Option<[Option<Range>; 3]>,
}

impl Limits {
    /// Return the edition with the ranges of these limits.
    pub(crate) fn applied(&self, edition: typed::Table) -> Result<typed::Table, Error> {
        self.check()?;
        if *self == Self::default() {
            return Ok(edition);
        }
        let mut edition = Arc::unwrap_or_clone(edition);
        if self.workspace.is_some() && !has_axes(&edition) {
            return Err(Error::usage(
                "a workspace needs the coordinates x, y, z; this edition does not have them",
            ));
        }
        let table = &edition.protocol.table;
        let mut commands = table.commands().to_vec();
        for (command, record) in commands.iter_mut().zip(&edition.commands) {
            for (index, variant) in command.request.iter_mut().enumerate() {
                *variant = self.narrowed(record, index, variant)?;
            }
        }
        let frame = table.frame().clone();
        edition.protocol.table = Table::new(frame, commands)
            .map_err(|_| Error::usage("the limits leave nothing of a range of this edition"))?;
        Ok(Arc::new(edition))
    }

    fn check(&self) -> Result<(), Error> {
        if let Some(speed) = self.speed.filter(|speed| !(1.0..=100.0).contains(speed)) {
            let text = bad_argument(
                "limits.speed",
                &Shown::Real(speed),
                "a number 1..100 percent",
            );
            return Err(Error::usage(text));
        }
        for (axis, range) in self.workspace.iter().flatten().enumerate() {
            if let Some((low, high)) =
                range.filter(|(low, high)| !(low <= high && (high - low).is_finite()))
            {
                let given = Shown::Tuple(vec![Shown::Real(low), Shown::Real(high)]);
                let argument = format!("limits.workspace[{axis}]");
                return Err(Error::usage(bad_argument(
                    &argument,
                    &given,
                    "a pair (lowest, highest), or None",
                )));
            }
        }
        Ok(())
    }

    /// Return a variant of a request with narrower ranges.
    fn narrowed(
        &self,
        command: &Command,
        index: usize,
        variant: &Variant,
    ) -> Result<Variant, Error> {
        let mut fields = variant.fields().to_vec();
        let names = command.request.get(index).into_iter().flatten();
        for (field, named) in fields.iter_mut().zip(names) {
            for (case, numbers) in field.cases.iter_mut().enumerate() {
                for (at, number) in numbers.numbers.iter_mut().enumerate() {
                    let Some(known) = named.number(case, at) else {
                        continue;
                    };
                    let axis = AXES.iter().position(|axis| *axis == known.name);
                    let range = match (self.speed, axis, &self.workspace) {
                        (Some(speed), _, _) if named.name == "speed" && known.unit == "percent" => {
                            Some((0.0, speed))
                        }
                        (_, Some(axis), Some(all)) if command.role == "coordinate targets" => {
                            all.get(axis).copied().flatten()
                        }
                        _ => None,
                    };
                    if let Some((low, high)) = range {
                        let (lowest, highest) = raw_range(number, (low, high));
                        let lowest = number.minimum.max(lowest);
                        let highest = number.maximum.min(highest);
                        if lowest > highest {
                            return Err(empty(axis, (low, high), number, &known.unit));
                        }
                        (number.minimum, number.maximum) = (lowest, highest);
                    }
                }
            }
        }
        Ok(Variant::new(fields))
    }
}

/// Return a range as raw values, rounded inwards; 0.1 is one tenth, not the float next to it.
fn raw_range(number: &Number, (low, high): Range) -> (i64, i64) {
    if number.float {
        // A lower limit of zero includes -0.0.
        let low = if low == 0.0 { -0.0 } else { low };
        let raw = |end| number.raw(end).unwrap_or_default();
        return (raw(low), raw(high + 0.0));
    }
    let (multiply, divide) = (number.multiply as f64, number.divide as f64);
    let raw = |end: f64| {
        (end * divide / multiply)
            .round_ties_even()
            .clamp(-9e15, 9e15)
    };
    let physical = |raw: f64| raw * multiply / divide;
    let (mut lowest, mut highest) = (raw(low), raw(high));
    if physical(lowest) < low {
        lowest += 1.0;
    }
    if physical(highest) > high {
        highest -= 1.0;
    }
    (lowest as i64, highest as i64)
}

/// Return why a range leaves nothing of that of a number.
fn empty(axis: Option<usize>, (low, high): Range, number: &Number, unit: &str) -> Error {
    let argument = axis.map_or("limits.speed".to_owned(), |axis| {
        format!("limits.workspace[{axis}]")
    });
    let end = |raw| match number.physical(raw) {
        cobotwire_core::Value::Real(real) => real,
        _ => raw as f64,
    };
    let (lowest, highest) = (end(number.minimum), end(number.maximum));
    let places: [(&str, &dyn std::fmt::Display); 3] =
        [("low", &lowest), ("high", &highest), ("unit", &unit)];
    let given = Shown::Tuple(vec![Shown::Real(low), Shown::Real(high)]);
    let allowed = cobotwire_table::error_text("workspace", &places);
    Error::usage(bad_argument(&argument, &given, &allowed))
}

fn has_axes(edition: &Edition) -> bool {
    let target = edition
        .commands
        .iter()
        .find(|each| each.role == "coordinate targets");
    let fields = target
        .and_then(|target| target.request.first())
        .into_iter()
        .flatten();
    let names: Vec<&str> = fields
        .flat_map(|field| field.cases.iter().flatten())
        .map(|number| &*number.name)
        .collect();
    AXES.iter().all(|axis| names.contains(axis))
}

/// Return the commands that are not sent within limits, each with the reason.
pub(crate) fn refusals(edition: &Edition, limits: &Limits) -> HashMap<usize, String> {
    let why = |command: &Command| {
        if *limits == Limits::default() || matches!(&*command.role, "stop" | "halt") {
            return None;
        }
        if command.safety == Safety::Persistent {
            return Some(
                "its effect stays, and limits.speed or limits.workspace is set".to_owned(),
            );
        }
        let moves = moves_arm(edition, command);
        let leaves = limits
            .workspace
            .and_then(|_| leaves_workspace(command, moves));
        let is_speed = |field: &cobotwire_table::Field| {
            field.name == "speed"
                && field
                    .cases
                    .iter()
                    .flatten()
                    .all(|number| number.unit == "percent")
        };
        let capped = command
            .request
            .iter()
            .all(|variant| variant.iter().any(is_speed));
        let fast = limits.speed.is_some() && moves && !capped;
        leaves.or(fast.then(|| "limits.speed is set, and it takes no speed in percent".to_owned()))
    };
    let commands = edition.commands.iter().enumerate();
    let refused = commands.filter_map(|(index, command)| {
        Some((
            index,
            format!("{}() is refused: {}", command.name, why(command)?),
        ))
    });
    refused.collect()
}

fn leaves_workspace(command: &Command, moves: bool) -> Option<String> {
    if command
        .stores
        .iter()
        .any(|state| FRAMES.contains(&&**state))
    {
        return Some("it changes what coordinates mean, and limits.workspace is set".to_owned());
    }
    match &*command.role {
        _ if !moves => None,
        "coordinate targets" => None,
        _ => Some(
            "limits.workspace is set, and where the end would go is not known before".to_owned(),
        ),
    }
}

/// Return whether a command may set joints in motion; one for the gripper does not.
fn moves_arm(edition: &Edition, command: &Command) -> bool {
    let find = |name: &str| edition.commands.iter().find(|each| each.name == name);
    let resumes = command
        .read_by
        .as_deref()
        .and_then(find)
        .is_some_and(|query| query.role == "paused");
    let gripper = edition.commands.iter().find(|each| each.role == "gripper");
    let of_gripper = gripper.is_some_and(|gripper| gripper.family == command.family)
        || command
            .request
            .iter()
            .flatten()
            .any(|field| field.name == "gripper_id");
    let starts = command.safety == Safety::Motion && !matches!(&*command.role, "stop" | "halt");
    starts && !resumes && !of_gripper
}
