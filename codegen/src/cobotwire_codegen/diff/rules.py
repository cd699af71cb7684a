"""Every rule: its id, its level and what it says. Ids are stable; messages may improve.

A difference that has several aspects has the level of the most severe one: a command that went
breaks the line and its callers, and is ``wire``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Level = Literal["wire", "api", "behaviour", "addition", "docs"]

# From the most severe to the least; what each means, in words.
LEVELS: dict[Level, str] = {
    "wire": "breaks the line: old and new peers misunderstand each other",
    "api": "breaks callers of the generated Python",
    "behaviour": "the same calls and bytes do or mean something else",
    "addition": "compatible: what worked goes on working",
    "docs": "words and evidence",
}


@dataclass(frozen=True, slots=True)
class Rule:
    """How severe a difference is, and the message, with {old} and {new}."""

    level: Level
    message: str


_WIRE = {
    "addresses-changed": "addresses were {old}, are {new}: frames go to others, or to nobody",
    "argument-added-required": "the request carries {new} now: it must be sent, and be given",
    "argument-removed": "the request carries {old} no more: none may send it, none may give it",
    "baudrate-changed": "the link ran at {old} baud, runs at {new}: peers hear noise",
    "byte-order-changed": "bytes stood {old} end first, stand {new} end first: numbers are misread",
    "check-changed": "frames were checked by {old}, are by {new}: each side refuses the other's",
    "command-removed": "the command {old} went: its frames are unknown now, its method is gone",
    "constant-changed": "the fixed number was {old}, is {new}: the other's frame is refused",
    "echo-changed": "the echo was {old}, is {new}: replies are matched to requests in another way",
    "enum-member-removed": "the member {old} went: frames that carry it are refused",
    "enum-member-renumbered": "{old} became {new}: the same word is another number on the line",
    "footer-changed": "the footer was {old}, is {new}: each side refuses the other's frames",
    "header-changed": "the header was {old}, is {new}: neither side sees the other's frames",
    "id-changed": "the id was {old}, is {new}: the call reaches another command, or none",
    "items-changed": "the parts were {old}, are {new}: numbers are misread, or refused",
    "reply-added": "nothing answered, now {new} does: old peers never send it",
    "reply-form-removed": "the reply ({old}) is refused now: old peers send it",
    "reply-layout-changed": "the reply was ({old}), is ({new}): it is misread or refused",
    "reply-removed": "the reply {old} went: what old peers answer is refused",
    "request-form-removed": "the request ({old}) is refused now: old peers send it",
    "request-layout-changed": "the request was ({old}), is ({new}): it is misread or refused",
    "result-added": "the reply carries {new} now: the shorter one of old peers is refused",
    "result-removed": "the reply carries {old} no more: the longer one of old peers is refused",
    "selector-changed": "what decides the type was {old}, is {new}: numbers are misread",
    "sign-rule-changed": "raw words stood for {old}, stand for {new}: some are misread",
    "text-changed": "the text was `{old}`, is `{new}`: it is misread",
    "type-layout-changed": "was {old} on the line, is {new}: the frame is misread or refused",
    "width-changed": "bytes were {old}, are {new}: the frame is refused",
}
_API = {
    "alias-removed": "the method {old} went; its message is {new} and stays",
    "argument-now-required": "could be left out, must be given now",
    "argument-order-changed": "the arguments were ({old}), are ({new})",
    "argument-renamed": "the argument {old} is {new} now",
    "argument-type-changed": "the argument took {old}, takes {new}",
    "class-removed": "the class {old} went",
    "class-renamed": "the class {old} is {new} now",
    "command-renamed": "the method {old} is {new} now; its message stays",
    "edition-removed": "the edition {old} went",
    "edition-renamed": "the edition {old} is {new} now: it is imported by another name",
    "enum-member-renamed": "the member {old} is {new} now; its number stays",
    "item-renamed": "the part {old} is {new} now; its place stays",
    "radians-changed": "callers spoke {old}, speak {new}: the same number is another angle",
    "result-now-optional": "was always there, may be missing now",
    "result-renamed": "the result {old} is {new} now",
    "result-type-changed": "callers got {old}, get {new}",
    "type-kind-changed": "was of the kind {old}, is {new}: callers give or get another one",
}
_BEHAVIOUR = {
    "agreement-changed": "agreed at rest with {old}, agrees with {new}: runs compare others",
    "read-back-changed": "was read back by {old}, is by {new}: a conformance run asks otherwise",
    "tries-changed": "a conformance run sent {old}, sends {new}",
    "ack-changed": "an acknowledgement, which is not waited for: was {old}, is {new}",
    "choices-narrowed": "legal numbers were {old}, are {new}: some are refused now",
    "choices-widened": "legal numbers were {old}, are {new}: an old peer refuses some",
    "deadline-changed": "an answer was awaited for {old} ms, is for {new} ms",
    "joints-changed": "the arm had {old} joints, has {new}",
    "maximum-data-changed": "a frame carried up to {old} data bytes, carries {new}",
    "range-moved": "the range was {old}, is {new}: values on either side are refused",
    "range-narrowed": "the range was {old}, is {new}: values between are refused now",
    "range-widened": "the range was {old}, is {new}: an old peer refuses values between",
    "role-changed": "the role was {old}, is {new}: waits and limits apply to other commands",
    "safety-changed": "was {old}, is {new}: retries and conformance runs treat it otherwise",
    "scale-changed": "a step was {old}, is {new}: the same bytes mean another value to an old peer",
    "selector-added": "its type is decided by {new} now: what that changes is listed by itself",
    "selector-removed": "its type was decided by {old}: what that changes is listed by itself",
    "shared-id-order-changed": "a frame of the id took the first name of {old}; now that of {new}",
    "silence-changed": "the text ended after {old} ms of silence, ends after {new} ms",
    "unit-changed": "the unit was {old}, is {new}: the same number means something else",
}
_ADDITION = {
    "address-added": "the address {new} came",
    "argument-added-optional": "the request may carry {new} now",
    "argument-now-optional": "had to be given, may be left out now",
    "argument-type-widened": "the argument took {old}, takes {new} now",
    "class-added": "the class {new} came",
    "command-added": "the command {new} came",
    "echo-loosened": "the echo was {old}, is {new}: replies without it are taken, too",
    "edition-added": "the edition {new} came",
    "enum-member-added": "the member {new} came: an old peer does not know it",
    "reply-form-added": "the reply may also be ({new})",
    "request-form-added": "the request may also be ({new})",
    "result-now-required": "could be missing, is always there now",
}
_DOCS = {
    "address-renamed": "the address {old} is called {new} now",
    "alias-changed": "its message was {old}, is {new}",
    "base-changed": "stood on {old}, stands on {new}: what that changes is listed by itself",
    "command-moved": "stood in the family {old}, stands in {new}",
    "dispute-added": "disputed now: {new}",
    "dispute-changed": "what is said on a dispute changed: {new}",
    "dispute-removed": "no longer disputed: {old}",
    "doc-changed": "said: {old}; says: {new}",
    "erratum-added": "a new erratum: {new}",
    "erratum-changed": "an erratum changed: {new}",
    "erratum-removed": "an erratum went: {old}",
    "family-added": "the family {new} came",
    "family-removed": "the family {old} went; its commands are listed by themselves",
    "family-renamed": "the family {old} is {new} now, and so is its page",
    "firmware-changed": "spoke of the firmware {old}, speaks of {new}",
    "history-changed": "what the delta says of itself changed: {new}",
    "note-changed": "the notes changed: {new}",
    "order-changed": "the order was {old}; is {new}",
    "range-restated": "the range is {new}, as before, but said in another way",
    "sharing-changed": "calls said to have the same id: {old}, then {new}",
    "source-changed": "the source was {old}, is {new}",
    "type-added": "the type {new} came",
    "type-removed": "the type {old} went",
    "type-renamed": "the type {old} is called {new} now, in the spec alone",
    "type-replaced": "used {old}, uses {new}: what that changes is listed by itself",
    "vector-added": "a vector for {new} came",
    "vector-changed": "the vector changed: {new}",
    "vector-removed": "a vector for {old} went",
}
_TABLES: dict[Level, dict[str, str]] = {
    "wire": _WIRE,
    "api": _API,
    "behaviour": _BEHAVIOUR,
    "addition": _ADDITION,
    "docs": _DOCS,
}

RULES = {
    rule: Rule(level, message)
    for level, rules in _TABLES.items()
    for rule, message in rules.items()
}
