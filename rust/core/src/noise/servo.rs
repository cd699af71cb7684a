//! Finds and interprets packets of the servo bus that leak into the traffic of the arm.

use std::collections::BTreeMap;

use crate::frame::FrameFormat;

/// The servo bus: its legal packets, and the names of their contents.
#[derive(Clone, Debug)]
pub struct ServoBus {
    /// The format of a packet.
    pub frame: FrameFormat,
    /// The legal LENs. Whether a packet is legal does not depend on its parameters.
    pub lengths: Vec<u16>,
    /// The id that stands for all servos.
    pub every: u8,
    /// The error bits of a status packet: names and masks.
    pub errors: Vec<(String, u8)>,
    /// The meaning of each register; empty if it has none.
    pub registers: Vec<String>,
    /// The instructions.
    pub instructions: Vec<Instruction>,
}

/// An instruction of the servo bus.
#[derive(Clone, Debug)]
pub struct Instruction {
    /// Its byte.
    pub code: u8,
    /// Its name.
    pub name: String,
    /// The legal LENs of its packets.
    pub lengths: Vec<u16>,
    /// The meanings of its parameters, in their order.
    pub operands: Vec<Operand>,
}

/// The meaning of one or more parameters of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// The first register.
    Register,
    /// The number of bytes for each servo.
    Count,
    /// The bytes to write: all remaining parameters.
    Data,
    /// The ids of servos: all remaining parameters. The value is the largest legal id.
    Servos(u8),
}

/// The register and the number of bytes that each servo sends in its next status packet.
pub type Expected = BTreeMap<u8, (u8, usize)>;

/// The contents of a packet.
pub(crate) struct Packet<'a> {
    /// The servo, or the id that stands for all.
    pub(crate) servo: u8,
    /// The code of the instruction, or the error bits of a status packet.
    pub(crate) code: u8,
    pub(crate) is_status: bool,
    /// Whether the packet is legal both as an instruction and as a status packet.
    pub(crate) ambiguous: bool,
    /// The instruction, if the parameters are legal for it.
    pub(crate) instruction: Option<&'a Instruction>,
    pub(crate) register: Option<u8>,
    /// The number of bytes to read from or write to a servo.
    pub(crate) count: Option<usize>,
    pub(crate) servos: Vec<u8>,
    pub(crate) parameters: &'a [u8],
}

impl ServoBus {
    /// Return the first byte of a packet.
    pub(super) fn first(&self) -> u8 {
        self.frame.header.first().copied().unwrap_or_default()
    }

    /// Return the end of the packet at `at`; `None` if no packet starts there. A frame of the arm
    /// may interrupt the packet.
    pub(super) fn end(&self, data: &[u8], at: usize) -> Option<usize> {
        let rest = data.get(at..)?;
        let layout = self.frame.layout;
        if !rest.starts_with(&self.frame.header) {
            return None;
        }
        let address = rest.get(layout.address_at?)?;
        let length = layout.length.read(rest)?;
        if !self.frame.addresses.contains(address) || !self.lengths.contains(&length) {
            return None;
        }
        let packet = rest.get(..layout.overhead + usize::from(length))?;
        self.frame.check.holds(packet).then_some(at + packet.len())
    }

    /// Interpret a packet; store in `expected` which status packets it requests.
    pub(crate) fn read<'a>(
        &'a self,
        data: &'a [u8],
        expected: &mut Expected,
    ) -> Option<Packet<'a>> {
        let layout = self.frame.layout;
        let servo = *data.get(layout.address_at?)?;
        let length = layout.length.read(data)?;
        let code = *data.get(layout.id.at)?;
        let end = data.len().checked_sub(self.frame.check.size())?;
        let parameters = data.get(layout.data_at..end)?;
        let known = self.instruction(code);
        let instruction = known.filter(|known| known.allows(length, parameters));
        let unknown = self
            .errors
            .iter()
            .fold(code, |rest, (_, mask)| rest & !mask);
        let may_be_status = servo != self.every && unknown == 0;
        let mut packet = Packet {
            servo,
            code,
            is_status: may_be_status && instruction.is_none(),
            ambiguous: may_be_status && instruction.is_some(),
            instruction,
            register: None,
            count: None,
            servos: Vec::new(),
            parameters,
        };
        packet.take_operands();
        if packet.is_status {
            let read = expected.remove(&servo);
            let read = read.filter(|(_, count)| *count == parameters.len());
            packet.register = read.map(|(register, _)| register);
        } else {
            packet.request(expected);
        }
        Some(packet)
    }

    /// Return the instruction with this code.
    pub(crate) fn instruction(&self, code: u8) -> Option<&Instruction> {
        self.instructions.iter().find(|known| known.code == code)
    }
}

impl Instruction {
    fn allows(&self, length: u16, parameters: &[u8]) -> bool {
        let servos = parameters.get(self.operands.len().saturating_sub(1)..);
        let are_servos = |most| servos.unwrap_or_default().iter().all(|id| *id <= most);
        let last = self.operands.last();
        let fits = !matches!(last, Some(Operand::Servos(most)) if !are_servos(*most));
        fits && self.lengths.contains(&length)
    }
}

impl Packet<'_> {
    fn take_operands(&mut self) {
        let Some(instruction) = self.instruction else {
            return;
        };
        let mut rest = self.parameters;
        for operand in &instruction.operands {
            match operand {
                Operand::Register => self.register = take(&mut rest),
                Operand::Count => self.count = take(&mut rest).map(usize::from),
                Operand::Servos(_) => self.servos = rest.to_vec(),
                Operand::Data => self.take_data(rest),
            }
        }
    }

    /// Without a count, all data is for one servo. With a count, the data holds the id of each
    /// servo, followed by that number of bytes.
    fn take_data(&mut self, data: &[u8]) {
        let count = *self.count.get_or_insert(data.len());
        if count != data.len() {
            self.servos = data.iter().step_by(count + 1).copied().collect();
        }
    }

    /// Replace `expected` with the status packets that this instruction requests.
    fn request(&self, expected: &mut Expected) {
        expected.clear();
        let operands = self.instruction.map_or(&[][..], |known| &known.operands);
        let (Some(register), Some(count)) = (self.register, self.count) else {
            return;
        };
        match operands {
            [Operand::Register, Operand::Count] => {
                expected.insert(self.servo, (register, count));
            }
            [.., Operand::Servos(_)] => {
                expected.extend(self.servos.iter().map(|servo| (*servo, (register, count))));
            }
            _ => {}
        }
    }
}

fn take(rest: &mut &[u8]) -> Option<u8> {
    let (first, more) = rest.split_first()?;
    *rest = more;
    Some(*first)
}
