//! The exchange. A line is a list of steps, each `[exchange, now, method, arguments...]`; the answer
//! is the list of their results, each with what can be seen of the exchange afterwards. Times are
//! nanoseconds, bytes hexadecimal digits. A request is given by its number: that of its ticket.

use std::collections::BTreeMap;
use std::sync::Arc;

use cobotwire_core::exchange::{
    Event, Exchange, Failure, Kind, LateFrame, Part, PersistedState, Received, ReplyError, Request,
    RetryPolicy, SeenFrame, Ticket, WaitedFor,
};
use cobotwire_core::{DecodeError, Decoded};
use cobotwire_table::Edition;
use serde_json::{Value as Json, json};

use crate::values::{Sample, from_hex, hex, nested};

/// The exchanges and editions of one process.
#[derive(Default)]
pub struct Exchanges {
    editions: BTreeMap<String, Arc<Edition>>,
    open: BTreeMap<u64, Open>,
}

/// An exchange, with its tickets by number.
#[derive(Clone)]
struct Open {
    edition: Arc<Edition>,
    exchange: Exchange,
    tickets: Vec<Ticket>,
}

type Answer = Result<Json, String>;

impl Exchanges {
    /// Answer one line.
    pub fn answer(&mut self, line: &str) -> String {
        let steps: Vec<Vec<Json>> = serde_json::from_str(line).unwrap_or_default();
        let answers = steps.iter().map(|step| {
            let answer = self.step(step);
            answer.unwrap_or_else(|error| json!({"error": error}))
        });
        Json::Array(answers.collect()).to_string()
    }

    fn step(&mut self, step: &[Json]) -> Answer {
        let [number, now, method, arguments @ ..] = step else {
            return Err("a step is a number, a time, a method and arguments".into());
        };
        let number = number.as_u64().ok_or("no number")?;
        let now = now.as_u64().ok_or("no time")?;
        let arguments = Arguments(arguments);
        match method.as_str().unwrap_or_default() {
            "new" => {
                let edition = self.edition(arguments.text(0)?)?;
                let open = Open {
                    exchange: Exchange::new(Arc::new(edition.protocol.clone())),
                    tickets: Vec::new(),
                    edition,
                };
                self.open.insert(number, open);
                Ok(Json::Null)
            }
            "fork" => {
                let copy = self.open.get(&number).cloned().ok_or("not open")?;
                self.open.insert(arguments.number(0)?, copy);
                Ok(Json::Null)
            }
            method => {
                let open = self.open.get_mut(&number).ok_or("not open")?;
                let result = match method {
                    "enqueue" | "send_one_way" => open.submit(method, &arguments, now),
                    _ => open.call(method, &arguments, now),
                }?;
                Ok(json!([result, open.look(now)]))
            }
        }
    }

    fn edition(&mut self, path: &str) -> Result<Arc<Edition>, String> {
        if let Some(edition) = self.editions.get(path) {
            return Ok(Arc::clone(edition));
        }
        let data = std::fs::read(path).map_err(|error| error.to_string())?;
        let edition = Edition::read(&data).map_err(|error| format!("{error:?}"))?;
        let edition = Arc::new(edition);
        self.editions.insert(path.into(), Arc::clone(&edition));
        Ok(edition)
    }
}

/// The arguments of a step.
struct Arguments<'a>(&'a [Json]);

impl Arguments<'_> {
    fn at(&self, index: usize) -> &Json {
        self.0.get(index).unwrap_or(&Json::Null)
    }

    fn text(&self, index: usize) -> Result<&str, String> {
        let text = self.at(index).as_str();
        text.ok_or_else(|| format!("argument {index} is no text"))
    }

    fn number(&self, index: usize) -> Result<u64, String> {
        let number = self.at(index).as_u64();
        number.ok_or_else(|| format!("argument {index} is no number"))
    }

    fn flag(&self, index: usize) -> bool {
        self.at(index) == &Json::Bool(true)
    }

    fn bytes(&self, index: usize) -> Result<Vec<u8>, String> {
        from_hex(self.at(index)).ok_or_else(|| format!("argument {index} is no bytes"))
    }
}

impl Open {
    fn submit(&mut self, method: &str, arguments: &Arguments<'_>, now: u64) -> Answer {
        let request = self.request(arguments.at(0))?;
        let (ends_by, time) = (arguments.at(1).as_u64(), arguments.at(2).as_u64());
        if method == "send_one_way" {
            let (data, ticket) = self.exchange.send_one_way(request, now, time, ends_by);
            self.tickets.extend(ticket);
            return Ok(json!([hex(&data), ticket.is_some()]));
        }
        let policy = policy(arguments.at(3));
        let ticket = self.exchange.enqueue(request, time, policy, now, ends_by);
        self.tickets.push(ticket);
        Ok(Json::Null)
    }

    fn call(&mut self, method: &str, arguments: &Arguments<'_>, now: u64) -> Answer {
        let exchange = &mut self.exchange;
        let ticket = || {
            let index = usize::try_from(arguments.number(0)?).unwrap_or(usize::MAX);
            let ticket = self.tickets.get(index).copied();
            ticket.ok_or_else(|| "no such ticket".to_owned())
        };
        match method {
            "give_up" => exchange.give_up(ticket()?),
            "written" => exchange.written(ticket()?, now),
            "fail_waiting" => exchange.fail_waiting(),
            "restore" => exchange.restore(&restored(arguments.at(0))),
            "note_full" => exchange.note_full(arguments.flag(0)),
            "aligned" => exchange.aligned(),
            _ => return self.ask(method, arguments, now),
        }
        Ok(Json::Null)
    }

    /// Call a method that returns something.
    fn ask(&mut self, method: &str, arguments: &Arguments<'_>, now: u64) -> Answer {
        let exchange = &mut self.exchange;
        Ok(match method {
            "fail" => events(&exchange.fail(now)),
            "persist" => persisted(&exchange.persist(now)),
            "cut" => {
                let (align, request) = (arguments.bytes(0)?, arguments.bytes(1)?);
                let written = arguments.at(2).as_u64();
                let written = written.and_then(|size| usize::try_from(size).ok());
                json!(exchange.cut(&align, &request, written))
            }
            "advance" => events(&exchange.advance(&arguments.bytes(0)?, now)),
            "receive" => events(&exchange.receive(&arguments.bytes(0)?, now)),
            "wake" => events(&exchange.wake(now)),
            "end_overdue" => events(&exchange.end_overdue(now)),
            "outgoing" => json!(hex(&exchange.outgoing(now, arguments.flag(0)))),
            "state" => json!(format!("{exchange:?}")),
            _ => return Err(format!("no method {method}")),
        })
    }

    /// Return what can be seen of the exchange; outcomes are taken.
    fn look(&mut self, now: u64) -> Json {
        let exchange = &mut self.exchange;
        let tickets = self.tickets.iter().enumerate();
        let ended: Vec<Json> = tickets
            .filter_map(|(index, ticket)| Some(json!([index, outcome(&exchange.take(*ticket)?)])))
            .collect();
        let last = exchange.sent_last();
        let last = last.and_then(|last| self.tickets.iter().position(|known| *known == last));
        json!([
            exchange.idle(now),
            exchange.busy(),
            exchange.has_next(now),
            hex(exchange.align()),
            last,
            ended
        ])
    }

    /// Return the request of `{"command", "values", "texts", "address", "variant"}`.
    fn request(&self, json: &Json) -> Result<Request, String> {
        let name = json.get("command").and_then(Json::as_str);
        let mut commands = self.edition.commands.iter();
        let command = commands.position(|command| Some(command.name.as_str()) == name);
        let values = Sample(json.get("values").cloned().unwrap_or_default());
        let texts = json.get("texts").and_then(Json::as_array);
        let texts = texts.into_iter().flatten().filter_map(Json::as_str);
        let texts: Vec<&str> = texts.collect();
        let number = |key: &str| json.get(key).and_then(Json::as_u64);
        let address = number("address").and_then(|address| u8::try_from(address).ok());
        let variant = number("variant").and_then(|variant| usize::try_from(variant).ok());
        let command = command.ok_or("no such command")?;
        Request::encode::<Sample>(
            &self.edition.protocol,
            command,
            &values,
            &texts,
            address,
            variant,
        )
        .map_err(|error| format!("{error:?}"))
    }
}

fn policy(json: &Json) -> RetryPolicy {
    let number = |index| json.get(index).and_then(Json::as_u64).unwrap_or_default();
    RetryPolicy {
        attempts: u8::try_from(number(0)).unwrap_or_default(),
        shortest_attempt: number(1),
        grace: number(2),
    }
}

fn persisted(state: &PersistedState) -> Json {
    let late = state
        .late
        .iter()
        .map(|late| json!([hex(&late.request), late.until]));
    let parts = state
        .parts
        .iter()
        .map(|part| json!([hex(&part.request), part.written]));
    json!([late.collect::<Json>(), parts.collect::<Json>()])
}

fn restored(json: &Json) -> PersistedState {
    let pairs = |index: usize| {
        let list = json.get(index).and_then(Json::as_array);
        list.into_iter()
            .flatten()
            .filter_map(|pair| Some((from_hex(pair.get(0)?)?, pair.get(1)?.as_u64()?)))
    };
    PersistedState {
        late: pairs(0)
            .map(|(request, until)| LateFrame { request, until })
            .collect(),
        parts: pairs(1)
            .map(|(request, written)| {
                let written = usize::try_from(written).unwrap_or(usize::MAX);
                Part { request, written }
            })
            .collect(),
    }
}

fn decoded(decoded: &Decoded) -> Json {
    let variant = decoded.variant;
    let values = nested(&decoded.values);
    json!([variant.command, variant.variant, values, decoded.address])
}

fn frame(frame: &SeenFrame) -> Json {
    json!([frame.offset, hex(frame.bytes())])
}

fn events(events: &[Event]) -> Json {
    events.iter().map(event).collect()
}

fn event(event: &Event) -> Json {
    match event {
        Event::Noise {
            offset,
            reason,
            data,
        } => json!(["noise", offset, reason.word(), hex(data)]),
        Event::Matched {
            command,
            decoded: reply,
            texts,
            frame: own,
        } => {
            let reply = reply.as_ref().map(decoded);
            json!(["matched", command, reply, texts, own.as_ref().map(frame)])
        }
        Event::Rejected {
            command,
            error,
            frame: own,
        } => {
            let error = own.as_ref().map(|own| wrong(error, own.bytes().len()));
            json!(["rejected", command, error, own.as_ref().map(frame)])
        }
        Event::Late {
            command,
            frame: own,
        } => json!(["late", command, frame(own)]),
        Event::Ack {
            command,
            decoded: reply,
            frame: own,
        } => {
            json!(["ack", command, decoded(reply), frame(own)])
        }
        Event::DeviceEvent {
            command,
            decoded: reply,
            frame: own,
        } => {
            json!(["event", command, decoded(reply), frame(own)])
        }
        Event::Unexpected { frame: own } => json!(["unexpected", frame(own)]),
        Event::Echo { frame: own } => json!(["echo", frame(own)]),
        Event::Expired {
            command,
            requested_at,
            attempts,
        } => {
            json!(["expired", command, requested_at, attempts])
        }
    }
}

fn outcome(outcome: &Result<cobotwire_core::exchange::Answer, Failure>) -> Json {
    match outcome {
        Ok(answer) => {
            let reply = answer.decoded.as_ref().map(decoded);
            let times = [answer.requested_at, answer.replied_at];
            json!({"answer": [reply, answer.texts, times]})
        }
        Err(failure) => failed(failure),
    }
}

fn failed(failure: &Failure) -> Json {
    match failure {
        Failure::Timeout {
            waited,
            attempts,
            waited_for,
            received,
        } => {
            let waited_for = waited_for.map(|waited_for| match waited_for {
                WaitedFor::Turn => "turn",
                WaitedFor::Hold => "hold",
                WaitedFor::Line => "line",
                WaitedFor::Reply => "reply",
            });
            let received: Vec<Json> = received.iter().map(item).collect();
            json!({"timeout": [waited, attempts, waited_for, received]})
        }
        Failure::Reply { error, data } => {
            json!({"reply": [wrong(error, data.len()), hex(data)]})
        }
        Failure::Refused {
            variant,
            field,
            value,
        } => {
            let value = nested(&[*value]);
            json!({"refused": [variant.command, variant.variant, field, value]})
        }
        Failure::Link => json!("link"),
    }
}

fn item(item: &Received) -> Json {
    let (kind, command, detail) = match item.kind {
        Kind::Noise(reason) => ("noise", None, json!(reason.word())),
        Kind::Late { command } => ("late", Some(command), Json::Null),
        Kind::DeviceEvent { command } => ("event", Some(command), Json::Null),
        Kind::Ack {
            command,
            perhaps_earlier,
        } => ("ack", Some(command), json!(perhaps_earlier)),
        Kind::Echo => ("echo", None, Json::Null),
        Kind::Unexpected => ("frame", None, Json::Null),
        Kind::Unread => ("unread", None, Json::Null),
    };
    json!([kind, command, detail, hex(&item.shown), item.size])
}

/// Return the reason and the offset of an error in `size` bytes.
fn wrong(error: &ReplyError, size: usize) -> Json {
    match error {
        ReplyError::Frame(DecodeError::Frame { reason, offset }) => json!([reason.word(), offset]),
        ReplyError::Frame(DecodeError::Raw(raw)) => json!(["bad-value", raw.offset]),
        ReplyError::Text(error) => json!(["bad-text", error.offset(size)]),
    }
}
