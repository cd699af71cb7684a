//! The steps of an exchange. Each result comes with the observable state of the exchange after the
//! step. Times are nanoseconds; bytes are hexadecimal digits; a request is given by the number of
//! its ticket, messages and errors by their texts. `tests/session/twins.py` is the other end.

use std::sync::Arc;

use cobotwire::Value;
use cobotwire_core::exchange::{
    Answer, Event, Exchange, Failure, Nanos, PersistedState, Request, RetryPolicy, Ticket,
};
use cobotwire_table::Edition;
use serde_json::{Value as Json, json};

use crate::values::{from_hex, hex, index, row_of};

/// An exchange, with its requests by the numbers of their tickets.
pub struct Open {
    edition: Arc<Edition>,
    exchange: Exchange,
    requests: Vec<(Ticket, Request)>,
}

impl Open {
    pub fn new(edition: Arc<Edition>) -> Self {
        Self {
            exchange: Exchange::new(Arc::new(edition.protocol.clone())),
            edition,
            requests: Vec::new(),
        }
    }

    /// Do a step; `left` is the state that the last exchange persisted.
    pub fn step(
        &mut self,
        method: &str,
        now: Nanos,
        given: &[Json],
        left: &mut PersistedState,
    ) -> Json {
        if method == "state" {
            return json!(format!("{:?}", self.exchange));
        }
        let result = self.call(method, now, given, left);
        json!([result, self.look(now)])
    }

    fn call(
        &mut self,
        method: &str,
        now: Nanos,
        given: &[Json],
        left: &mut PersistedState,
    ) -> Json {
        let exchange = &mut self.exchange;
        let (number, bytes) = (
            |at: usize| given[at].as_u64(),
            |at: usize| from_hex(&given[at]),
        );
        let ticket = || self.requests[number(0).unwrap() as usize].0;
        let events = match method {
            "give_up" => return json!(exchange.give_up(ticket())),
            "written" => return json!(exchange.written(ticket(), now)),
            "restore" => return json!(exchange.restore(left)),
            "note_full" => return json!(exchange.note_full(given[0] == true)),
            "end" => return json!(exchange.aligned()),
            "fail_waiting" => return json!(exchange.fail_waiting()),
            "prepare" => return json!(self.request(&given[0]).err()),
            "enqueue" => {
                let [request, wait, policy, ends_by] = [0, 1, 2, 3].map(|at| &given[0][at]);
                let request = self.request(request).unwrap();
                let (own, wait, policy) = (request.clone(), wait.as_u64(), retry_policy(policy));
                let exchange = &mut self.exchange;
                let ticket = exchange.enqueue(own, wait, policy, now, ends_by.as_u64());
                self.requests.push((ticket, request));
                return Json::Null;
            }
            "send_one_way" => {
                let (request, count) = (self.request(&given[0]).unwrap(), self.requests.len());
                let (own, within, ends_by) = (request.clone(), number(1), number(2));
                let (data, ticket) = self.exchange.send_one_way(own, now, within, ends_by);
                self.requests.extend(ticket.map(|ticket| (ticket, request)));
                return json!([hex(&data), ticket.map(|_| count)]);
            }
            "persist" => {
                *left = exchange.persist(now);
                return persisted(left);
            }
            "cut" => {
                let written = number(2).map(|size| size as usize);
                return json!(exchange.cut(&bytes(0), &bytes(1), written));
            }
            "outgoing" => return json!(hex(&exchange.outgoing(now, given[0] == true))),
            "fail" => exchange.fail(now),
            "advance" => exchange.advance(&bytes(0), now),
            "receive" => exchange.receive(&bytes(0), now),
            "wake" => exchange.wake(now),
            _ => exchange.end_overdue(now),
        };
        events.iter().map(|event| self.event(event)).collect()
    }

    /// Return the observable state of the exchange, and take the outcomes of requests that have
    /// ended.
    fn look(&mut self, now: Nanos) -> Json {
        let exchange = &mut self.exchange;
        let tickets = self.requests.iter().enumerate();
        let ended = tickets.filter_map(|(index, (ticket, request))| {
            let outcome = exchange.take(*ticket)?;
            Some((index, request, outcome))
        });
        let ended: Vec<_> = ended.collect();
        let ended = ended.iter().map(|(index, request, outcome)| {
            let outcome = outcome.as_ref();
            let failed = |why| self.failed(request, why);
            json!([
                index,
                outcome.map_or_else(failed, |answer| self.answered(request, answer))
            ])
        });
        let ended: Json = ended.collect();
        let exchange = &self.exchange;
        let last = exchange.sent_last();
        let last = last.and_then(|last| self.requests.iter().position(|each| each.0 == last));
        json!([exchange.idle(now), hex(exchange.align()), last, ended])
    }

    /// Return the request of `[command, values, texts, address, variant]`, or the text of its
    /// error.
    fn request(&self, json: &Json) -> Result<Request, String> {
        let (edition, command) = (&*self.edition, index(&self.edition, &json[0]));
        let (values, texts) = (row_of(&json[1]), json[2].as_array().unwrap());
        let texts: Vec<&str> = texts.iter().filter_map(Json::as_str).collect();
        let address = json[3].as_u64().map(|address| address as u8);
        let variant = json[4].as_u64().map(|variant| variant as usize);
        let protocol = &edition.protocol;
        Request::encode::<Value>(protocol, command, &values, &texts, address, variant).map_err(
            |error| edition.request_error(command, &error, (values.len(), &texts, address)),
        )
    }

    /// Return the name of an event, its command, its content, and its bytes.
    fn event(&self, event: &Event) -> Json {
        let (command, says) = match event {
            Event::Noise { reason, .. } => (None, json!(reason.word())),
            Event::Matched {
                command,
                decoded: None,
                texts,
                ..
            } => (Some(command), json!(texts)),
            Event::Matched {
                command,
                decoded: Some(own),
                ..
            }
            | Event::Ack {
                command,
                decoded: own,
                ..
            }
            | Event::DeviceEvent {
                command,
                decoded: own,
                ..
            } => (Some(command), json!(self.edition.message(own))),
            Event::Expired {
                command,
                requested_at,
                attempts,
            } => (Some(command), json!([requested_at, attempts])),
            Event::Late { command, .. } | Event::Rejected { command, .. } => {
                (Some(command), Json::Null)
            }
            Event::Unexpected { .. } | Event::Echo { .. } => (None, Json::Null),
        };
        let (text, data) = (format!("{event:?}"), hex(event.data()));
        let name = text.trim_start_matches("Device").split(' ').next();
        let command = command.map(|index| &self.edition.commands[*index].name);
        json!([name, command, says, data])
    }

    fn answered(&self, request: &Request, answer: &Answer) -> Json {
        let facts = &self.edition.protocol.facts[request.command];
        let names = facts.text.iter().flat_map(|form| &form.fields);
        let texts = names.zip(&answer.texts);
        let texts: Vec<_> = texts.map(|(name, text)| format!("{name}={text}")).collect();
        let fields = answer.decoded.as_ref().map(|own| self.edition.fields(own));
        let fields = fields.unwrap_or_else(|| texts.join(", "));
        json!(["answer", fields, [answer.requested_at, answer.replied_at]])
    }

    fn failed(&self, request: &Request, failure: &Failure) -> Json {
        let (class, waited) = match failure {
            Failure::Timeout { waited, .. } => ("ReplyTimeout", Some(waited)),
            Failure::Reply { .. } => ("ProtocolError", None),
            Failure::Refused { .. } => ("RequestRefused", None),
            Failure::Link => ("LinkError", None),
        };
        let text = self.edition.failure(request, failure);
        json!([class, text, waited])
    }
}

fn retry_policy(json: &Json) -> RetryPolicy {
    let number = |index: usize| json[index].as_u64().unwrap();
    RetryPolicy {
        attempts: number(0) as u8,
        shortest_attempt: number(1),
        grace: number(2),
    }
}

fn persisted(state: &PersistedState) -> Json {
    let (late, parts) = (state.late.iter(), state.parts.iter());
    let late: Json = late
        .map(|late| json!([hex(&late.request.frame), late.until]))
        .collect();
    let parts: Json = parts
        .map(|part| json!([hex(&part.request), part.written]))
        .collect();
    json!([late, parts])
}
