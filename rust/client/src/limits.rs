//! Limits: a highest speed, and a box for the end of the arm.

use std::fmt::Display;
use std::sync::Arc;

use cobotwire_core::exchange::Safety;
use cobotwire_core::{self as wire, Number, Table};
use cobotwire_table::{Command, Edition, Field, Value, bad_argument, error_text};

use crate::Error;
use crate::typed;

/// The lowest and the highest allowed value.
pub type Range = (f64, f64);

const AXES: [&str; 3] = ["x", "y", "z"];
/// States that decide what coordinates mean.
const FRAMES: [&str; 4] = ["tool", "world", "reference_frame", "end_type"];
/// The state that decides what a speed in percent means.
const HIGHEST_SPEED: &str = "max_speed";

/// The highest speed of an arm, and where its end may go. Requests that could exceed a limit are
/// refused before a byte is sent, and so are persistent writes. Nothing limits `stop`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// The highest speed in percent, 1..100.
    pub speed: Option<f64>,
    /// Ranges for x, y and z in millimetres: where coordinates may send the end of the arm. If they
    /// are set, motions to joint angles are refused. The path to a target is not checked.
    pub workspace: Option<[Option<Range>; 3]>,
}

impl Limits {
    /// Return the edition with the ranges of its requests narrowed to these limits.
    pub(crate) fn applied(&self, edition: typed::Table) -> Result<typed::Table, Error> {
        self.check(&edition)?;
        if *self == Self::default() {
            return Ok(edition);
        }
        let mut edition = Arc::unwrap_or_clone(edition);
        let table = &edition.protocol.table;
        let mut commands = table.commands().to_vec();
        for (command, record) in commands.iter_mut().zip(&edition.commands) {
            for (variant, named) in command.request.iter_mut().zip(&record.request) {
                let mut fields = variant.fields().to_vec();
                for (field, named) in fields.iter_mut().zip(named) {
                    for (case, numbers) in field.cases.iter_mut().enumerate() {
                        for (at, number) in numbers.numbers.iter_mut().enumerate() {
                            self.narrow(number, record, named, (case, at))?;
                        }
                    }
                }
                *variant = wire::Variant::new(fields);
            }
        }
        edition.protocol.table = Table::new(table.frame().clone(), commands).map_err(|_| {
            Error::usage("the limits exclude every value of a range of this edition")
        })?;
        Ok(Arc::new(edition))
    }

    fn check(&self, edition: &Edition) -> Result<(), Error> {
        if let Some(speed) = self.speed.filter(|speed| !(1.0..=100.0).contains(speed)) {
            let allowed = error_text("speed", &[]);
            let text = bad_argument("limits.speed", &Value::Real(speed), &allowed);
            return Err(Error::usage(text));
        }
        let Some(workspace) = &self.workspace else {
            return Ok(());
        };
        let pair = error_text("pair", &[]);
        let illegal = |(low, high): &Range| !(low <= high && (high - low).is_finite());
        for (axis, range) in workspace.iter().enumerate() {
            let range = range.filter(illegal);
            range.map_or(Ok(()), |range| Err(bad_range(axis, range, &pair)))?;
        }
        let target = find(edition, |each| each.role == "coordinate targets");
        let fields = target.and_then(|target| target.request.first());
        let cases = fields.into_iter().flatten().flat_map(|field| &field.cases);
        let names: Vec<&str> = cases.flatten().map(|number| &*number.name).collect();
        if !AXES.iter().all(|axis| names.contains(axis)) {
            let text = error_text("no-coordinates", &[("names", &names.join(", "))]);
            return Err(Error::usage(text));
        }
        Ok(())
    }

    /// Narrow the range of a number of a request to these limits.
    fn narrow(
        &self,
        number: &mut Number,
        command: &Command,
        field: &Field,
        (case, at): (usize, usize),
    ) -> Result<(), Error> {
        let Some(known) = field.number(case, at) else {
            return Ok(());
        };
        if let Some(speed) = self.speed.filter(|_| is_speed(field)) {
            number.maximum = number.maximum.min(raw_range(number, (0.0, speed)).1);
        }
        let axis = AXES.iter().position(|axis| *axis == known.name);
        let axis = axis.filter(|_| command.role == "coordinate targets");
        let range = axis.and_then(|axis| self.workspace.as_ref()?.get(axis).copied()?);
        let Some((axis, range)) = axis.zip(range) else {
            return Ok(());
        };
        let (lowest, highest) = raw_range(number, range);
        let (lowest, highest) = (lowest.max(number.minimum), highest.min(number.maximum));
        if lowest > highest {
            let end = |raw| match number.physical(raw) {
                wire::Value::Real(real) => real,
                _ => raw as f64,
            };
            let (low, high) = (end(number.minimum), end(number.maximum));
            let places: [(&str, &dyn Display); 3] =
                [("low", &low), ("high", &high), ("unit", &known.unit)];
            return Err(bad_range(axis, range, &error_text("workspace", &places)));
        }
        (number.minimum, number.maximum) = (lowest, highest);
        Ok(())
    }

    /// Return why these limits refuse a command; `None` if they do not.
    pub(crate) fn refusal(&self, edition: &Edition, command: &Command) -> Option<String> {
        let (fast, far) = (self.speed.is_some(), self.workspace.is_some());
        if !fast && !far || is_stop(command) {
            return None;
        }
        let moves = moves_arm(edition, command);
        let stores = |states: &[&str]| {
            command
                .stores
                .iter()
                .any(|state| states.contains(&&**state))
        };
        let is_capped = |variant: &Vec<Field>| variant.iter().any(is_speed);
        let kind = if command.safety == Safety::Persistent {
            "refused-lasting"
        } else if far && stores(&FRAMES) {
            "refused-frame"
        } else if far && moves && command.role != "coordinate targets" {
            "refused-blind"
        } else if fast && stores(&[HIGHEST_SPEED]) {
            "refused-scale"
        } else if fast && moves && !command.request.iter().all(is_capped) {
            "refused-speedless"
        } else {
            return None;
        };
        Some(error_text(kind, &[("command", &command.name)]))
    }
}

fn bad_range(axis: usize, (low, high): Range, allowed: &str) -> Error {
    let given = Value::Row(vec![Value::Real(low), Value::Real(high)]);
    let argument = format!("limits.workspace[{axis}]");
    Error::usage(bad_argument(&argument, &given, allowed))
}

/// Return whether a field is a speed in percent.
fn is_speed(field: &Field) -> bool {
    let mut numbers = field.cases.iter().flatten();
    field.name == "speed" && numbers.all(|number| number.unit == "percent")
}

/// Return a range as raw values, rounded inwards. An end means its decimal: 0.1 is one tenth, not
/// the double nearest to it.
fn raw_range(number: &Number, (low, high): Range) -> (i64, i64) {
    if number.is_float() {
        // A lower limit of zero includes -0.0.
        let low = if low == 0.0 { -0.0 } else { low };
        let raw = |end| number.raw(end).unwrap_or_default();
        return (raw(low), raw(high + 0.0));
    }
    let (multiply, divide) = (number.multiply as f64, number.divide as f64);
    let nearest = |end: f64| (end * divide / multiply).round_ties_even();
    let (lowest, highest) = (nearest(low), nearest(high));
    let physical = |raw: f64| raw * multiply / divide;
    let more = i64::from(physical(lowest) < low);
    let less = i64::from(physical(highest) > high);
    let raw = |nearest: f64| nearest.clamp(-9e15, 9e15) as i64;
    (raw(lowest) + more, raw(highest) - less)
}

fn find(edition: &Edition, is: impl Fn(&Command) -> bool) -> Option<&Command> {
    edition.commands.iter().find(|each| is(each))
}

/// Return whether a command stops the arm or ends its motion.
fn is_stop(command: &Command) -> bool {
    matches!(&*command.role, "stop" | "halt")
}

/// Return whether a command may set joints in motion. Commands for the gripper do not.
fn moves_arm(edition: &Edition, command: &Command) -> bool {
    let read_by = |each: &Command| Some(&each.name) == command.read_by.as_ref();
    let resumes = find(edition, read_by).is_some_and(|query| query.role == "paused");
    let gripper = find(edition, |each| each.role == "gripper");
    let of_gripper = gripper.is_some_and(|gripper| gripper.family == command.family);
    let mut fields = command.request.iter().flatten();
    let starts = command.safety == Safety::Motion && !is_stop(command);
    starts && !resumes && !of_gripper && !fields.any(|field| field.name == "gripper_id")
}
