//! A damaged file of an edition is refused with a message, or it gives an exchange in which each byte
//! is in one event and each wait ends.

use std::sync::{Arc, LazyLock};

use cobotwire_core::exchange::{Event, Exchange, Nanos, Request, RetryPolicy, Ticket};
use cobotwire_core::{Direction, Event as Received, Framer, Listening};
use cobotwire_table::Edition;
use serde_json::Value;

use crate::bytes::Bytes;
use crate::damage::changed;
use crate::script;
use crate::subjects::variants;

/// The unit of random times: a 64th of a second.
const UNIT: Nanos = 15_625_000;

/// The files that are damaged. The second one has addresses.
static DOCUMENTS: LazyLock<[Value; 2]> = LazyLock::new(|| {
    let files: [&[u8]; 2] = [
        include_bytes!("../../../../python/cobotwire/editions/mycobot/edition.json"),
        include_bytes!("../../../../python/cobotwire/editions/mybuddy/edition.json"),
    ];
    files.map(|file| serde_json::from_slice(file).expect("the generator writes JSON"))
});

/// Damage a file as fuzz bytes say. If it is still accepted, drive its exchange by further bytes.
pub fn file_is_refused_or_every_byte_is_in_one_event_and_every_wait_ends(data: &[u8]) {
    let mut bytes = Bytes(data);
    let edition = match Edition::read(&changed(&DOCUMENTS[bytes.pick(2)], &mut bytes)) {
        Err(error) => return assert!(error.to_string().contains(' '), "{error}"),
        Ok(edition) => edition,
    };
    let (protocol, size) = (Arc::new(edition.protocol), bytes.0.len() / 2);
    let table = &protocol.table;
    let stream = script::play(table, &variants(table), Bytes(bytes.take(size)));
    let mut requests = Vec::new();
    let rules = table.rules(Listening::To(Direction::Request));
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

    /// Let time pass until no request waits; check that each received byte was in one event.
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
