//! Tests what the comparison with the exchange in Python does not cover: outcomes that are taken
//! later. The comparison takes each outcome at once.

use std::sync::Arc;

use cobotwire_core::exchange::{
    Exchange, Facts, Failure, Protocol, Request, RetryPolicy, Safety, Ticket,
};

use crate::common::table;

/// Return an exchange, and the ticket of a request that the loss of the transport has ended.
fn ended() -> (Exchange, Ticket) {
    let facts = Facts {
        safety: Safety::Query,
        deadline: 1,
        ack: false,
        event: false,
        text: None,
        request_text: None,
        request: vec![vec![]],
        reply: vec![vec![]],
        accepted: vec![],
    };
    let protocol = Arc::new(Protocol {
        table: table(vec![vec![]]),
        facts: vec![facts],
        reports_ends: false,
        addresses: vec![],
        joints: 6,
    });
    let request = Request::from_frame(&protocol, &[0xFE, 0xFE, 2, 0x20, 0xFA]);
    let mut exchange = Exchange::new(protocol);
    let policy = RetryPolicy::default();
    let ticket = exchange.enqueue(request.unwrap(), None, policy, 0, None);
    exchange.fail(1);
    (exchange, ticket)
}

#[test]
fn outcome_of_ended_request_is_kept_unless_the_request_is_given_up() {
    let (mut exchange, ticket) = ended();
    assert_eq!(exchange.take(ticket), Some(Err(Failure::Link)));
    let (mut exchange, ticket) = ended();
    exchange.give_up(ticket);
    assert_eq!(exchange.take(ticket), None);
}
