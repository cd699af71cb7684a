//! The exchange with any table, facts, bytes and times: each byte is in one event, each wait ends.

use std::sync::Arc;

use cobotwire_core::exchange::{
    Event, Exchange, Facts, Named, Nanos, Protocol, Request, RetryPolicy, Safety, TextForm, Ticket,
};
use cobotwire_core::{Command, Direction, Event as Received, Framer, Listening, Table, Variant};

use crate::bytes::Bytes;
use crate::random;
use crate::script;
use crate::subjects::variants;

/// The unit of random times: a 64th of a second.
const UNIT: Nanos = 15_625_000;

/// Check an exchange that is driven by fuzz bytes.
pub fn every_byte_is_in_one_event_and_every_wait_ends(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (format, commands) = random::table(&mut bytes);
    let facts = commands.iter().map(|command| facts(&mut bytes, command));
    let facts = facts.collect();
    let Ok(table) = Table::new(format, commands) else {
        return;
    };
    let size = bytes.0.len() / 2;
    let stream = script::play(&table, &variants(&table), Bytes(bytes.take(size)));
    let protocol = Arc::new(Protocol {
        table,
        facts,
        reports_ends: bytes.byte() & 1 == 1,
        addresses: Vec::new(),
        joints: 6,
    });
    let mut requests = Vec::new();
    let rules = protocol.table.rules(Listening::To(Direction::Request));
    Framer::new(rules.clone()).feed(&stream, |event| {
        if let Received::Frame { frame, .. } = event {
            requests.extend(Request::from_frame(&protocol, frame.bytes()));
        }
    });
    let mut run = Run {
        exchange: Exchange::new(protocol),
        now: bytes.word() as Nanos * UNIT,
        covered: 0,
        tickets: Vec::new(),
    };
    let mut rest = stream.as_slice();
    while !bytes.is_done() {
        run.step(&mut bytes, &requests, &mut rest);
    }
    run.end(stream.len() - rest.len());
}

struct Run {
    exchange: Exchange,
    now: Nanos,
    /// How many received bytes were in events.
    covered: usize,
    tickets: Vec<Ticket>,
}

impl Run {
    fn step(&mut self, bytes: &mut Bytes<'_>, requests: &[Request], rest: &mut &[u8]) {
        let (kind, detail) = (bytes.byte() % 10, bytes.byte());
        let time = Nanos::from(detail) * UNIT;
        let request = requests.get(bytes.pick(requests.len()));
        match (kind, request) {
            (0 | 1, Some(request)) => {
                let policy = RetryPolicy {
                    attempts: detail & 7,
                    ..RetryPolicy::default()
                };
                let ends_by = (detail & 8 == 8).then_some(self.now + time);
                let (request, now) = (request.clone(), self.now);
                let ticket = self
                    .exchange
                    .enqueue(request, Some(time), policy, now, ends_by);
                self.tickets.push(ticket);
            }
            (2, Some(request)) => {
                let (request, within) = (request.clone(), Some(time));
                let sent = self.exchange.send_one_way(request, self.now, within, None);
                self.tickets.extend(sent.1);
            }
            (3, Some(request)) if request.frame.len() < 64 => {
                let align = self.exchange.align().to_vec();
                let written = (detail < 250).then_some(usize::from(detail));
                self.exchange.cut(&align, &request.frame, written);
            }
            (4, _) => {
                let events = self.exchange.fail(self.now);
                self.cover(&events);
            }
            (5, _) => {
                let given_up = self.tickets.get(usize::from(detail));
                given_up
                    .into_iter()
                    .for_each(|ticket| self.exchange.give_up(*ticket));
            }
            (6 | 7, _) => self.now += time,
            _ => {
                let (chunk, after) = rest.split_at(usize::from(detail).min(rest.len()));
                *rest = after;
                let events = self.exchange.advance(chunk, self.now);
                self.cover(&events);
                self.exchange.outgoing(self.now, detail & 1 == 0);
            }
        }
    }

    fn cover(&mut self, events: &[Event]) {
        let sizes = events.iter().map(|event| event.data().len());
        self.covered += sizes.sum::<usize>();
    }

    /// Let time pass until nobody waits; check what was received.
    fn end(mut self, received: usize) {
        let most = 200 + 10 * self.tickets.len();
        for _ in 0..most {
            self.now += self.exchange.idle(self.now).unwrap_or_default().max(1);
            let events = self.exchange.advance(&[], self.now);
            self.cover(&events);
            self.exchange.outgoing(self.now, true);
        }
        assert!(self.exchange.idle(self.now).is_none(), "a request waits");
        let events = self.exchange.fail(self.now);
        self.cover(&events);
        assert_eq!(self.covered, received, "each byte is in one event");
    }
}

/// Return what any command may be.
fn facts(bytes: &mut Bytes<'_>, command: &Command) -> Facts {
    const SAFETIES: [Safety; 3] = [Safety::Query, Safety::Setting, Safety::Motion];
    let flags = bytes.byte();
    let form = || TextForm {
        prefixes: vec!["a".into(), "b".into()],
        fields: vec!["one".into(), "two".into()],
        suffix: "".into(),
        silence: 4 * UNIT,
    };
    let named = |variants: &[Variant]| {
        let fields = |variant: &Variant| {
            let names = (0..variant.fields().len()).map(|index| Named {
                name: index.to_string().into(),
                echo: flags >> (index % 8) & 1 == 1,
                status: true,
            });
            names.collect()
        };
        variants.iter().map(fields).collect()
    };
    Facts {
        safety: SAFETIES[usize::from(flags) % SAFETIES.len()],
        deadline: Nanos::from(flags) * UNIT,
        ack: flags & 4 == 4,
        event: flags & 24 == 24,
        text: (flags & 0xE0 == 0xE0).then(form),
        request_text: None,
        request: named(&command.request),
        reply: named(&command.reply),
        accepted: Vec::from_iter((flags & 2 == 2).then_some(1)),
    }
}
