//! Describes packets of the servo bus, as Python's `cobotwire.diagnose.servo` does.

use std::fmt::Write;

use super::repr;
use crate::noise::{Operand, Packet, ServoBus};

/// Append text and facts of a packet.
pub(super) fn append(out: &mut Vec<u8>, bus: &ServoBus, packet: &Packet<'_>) {
    let name = name(bus, packet);
    out.extend_from_slice(b"\"text\": ");
    repr::text(out, text(bus, packet, &name).chars());
    out.extend_from_slice(b", \"facts\": {\"servo\": ");
    repr::natural(out, u64::from(packet.servo));
    out.extend_from_slice(b", \"role\": ");
    let role = if packet.is_status {
        "status"
    } else {
        "instruction"
    };
    repr::text(out, role.chars());
    out.extend_from_slice(b", \"ambiguous\": ");
    out.extend_from_slice(if packet.ambiguous { b"true" } else { b"false" });
    out.extend_from_slice(b", \"instruction\": ");
    repr::optional(out, (!packet.is_status).then_some(&name), |out, name| {
        repr::text(out, name.chars());
    });
    out.extend_from_slice(b", \"error\": ");
    number(out, packet.is_status.then_some(packet.code));
    out.extend_from_slice(b", \"errors\": ");
    repr::list(out, errors(bus, packet), |out, name| {
        repr::text(out, name.chars())
    });
    out.extend_from_slice(b", \"register\": ");
    number(out, packet.register);
    out.extend_from_slice(b", \"register_name\": ");
    let meaning = packet.register.and_then(|register| meaning(bus, register));
    repr::optional(out, meaning, |out, name| repr::text(out, name.chars()));
    out.extend_from_slice(b", \"count\": ");
    repr::optional(out, packet.count, |out, count| {
        repr::natural(out, count as u64)
    });
    out.extend_from_slice(b", \"servos\": ");
    let servos = packet.servos.iter();
    repr::list(out, servos, |out, servo| {
        repr::natural(out, u64::from(*servo))
    });
    out.extend_from_slice(b", \"parameters\": \"");
    repr::hex(out, packet.parameters.iter().copied());
    out.extend_from_slice(b"\"}");
}

fn number(out: &mut Vec<u8>, number: Option<u8>) {
    repr::optional(out, number, |out, number| {
        repr::natural(out, u64::from(number))
    });
}

/// Return the name of the instruction, whatever its parameters are.
fn name(bus: &ServoBus, packet: &Packet<'_>) -> String {
    let known = bus.instruction(packet.code);
    known.map_or_else(
        || format!("0x{:02X}", packet.code),
        |known| known.name.clone(),
    )
}

/// Return the names of the error bits of a status packet.
fn errors<'a>(bus: &'a ServoBus, packet: &Packet<'_>) -> impl Iterator<Item = &'a str> {
    let code = if packet.is_status { packet.code } else { 0 };
    let set = bus.errors.iter().filter(move |(_, mask)| code & mask != 0);
    set.map(|(name, _)| name.as_str())
}

fn meaning(bus: &ServoBus, register: u8) -> Option<&str> {
    let meaning = bus.registers.get(usize::from(register))?;
    (!meaning.is_empty()).then_some(meaning.as_str())
}

fn text(bus: &ServoBus, packet: &Packet<'_>, name: &str) -> String {
    let mut text = String::from("servo bus: ");
    let servo = servo(bus, packet);
    let place = packet.register.map(|register| place(bus, register));
    let parameters = packet.parameters;
    match (packet.is_status, place) {
        (true, place) => {
            text = text + "status of " + &servo;
            if !parameters.is_empty() {
                hex(&mut text, parameters);
                let place = place.map(|place| format!(" at {place}"));
                text += &place.unwrap_or_default();
            }
            let names: Vec<&str> = errors(bus, packet).collect();
            if !names.is_empty() {
                text = text + ", with errors: " + &names.join(", ");
            }
        }
        (false, None) => {
            text = text + name + " of " + &servo;
            hex(&mut text, parameters);
        }
        (false, Some(place)) => {
            let count = packet.count.unwrap_or_default();
            text = text + name + &format!(" {count} bytes at {place} of {servo}");
            let operands = packet.instruction.map(|known| known.operands.as_slice());
            if operands == Some(&[Operand::Register, Operand::Data]) {
                text.push(':');
                hex(&mut text, parameters.get(1..).unwrap_or_default());
            }
        }
    }
    if packet.ambiguous {
        text += " (or a status with errors)";
    }
    text
}

fn servo(bus: &ServoBus, packet: &Packet<'_>) -> String {
    if !packet.servos.is_empty() {
        let servos: Vec<String> = packet.servos.iter().map(u8::to_string).collect();
        return format!("servos {}", servos.join(", "));
    }
    if packet.servo == bus.every {
        return String::from("all servos");
    }
    format!("servo {}", packet.servo)
}

fn place(bus: &ServoBus, register: u8) -> String {
    let meaning = meaning(bus, register).map(|meaning| format!(" ({meaning})"));
    format!("register 0x{register:02X}{}", meaning.unwrap_or_default())
}

/// Append a space and pairs of hex digits for each byte.
fn hex(text: &mut String, bytes: &[u8]) {
    for byte in bytes {
        // Writing to a string cannot fail.
        let _ = write!(text, " {byte:02x}");
    }
}
