"""Every rule: its id, its level and its message. Ids are stable; messages may improve.

A difference with several aspects has the level of the most severe one: a removed command
breaks the protocol and its callers, and is ``wire``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Level = Literal["wire", "api", "behaviour", "peer", "addition", "docs"]

# From the most severe to the least, each with its meaning.
LEVELS: dict[Level, str] = {
    "wire": "breaks the protocol: old and new peers misunderstand each other",
    "api": "breaks callers of the generated Python",
    "behaviour": "the same requests and bytes do or mean something else",
    "peer": "a peer of the other version may receive values that it does not know",
    "addition": "compatible: what worked keeps working",
    "docs": "words and evidence",
}


@dataclass(frozen=True, slots=True)
class Rule:
    """How severe a difference is, and the message, with {old} and {new}."""

    level: Level
    message: str


_WIRE = {
    "address-replies-changed": "its replies came from {old}, come from {new}: they are mismatched",
    "addresses-changed": "addresses were {old}, are {new}: frames reach other devices, or none",
    "argument-added-required": "the request now carries {new}: callers must pass it",
    "argument-removed": "the request no longer carries {old}: callers cannot pass it",
    "baudrate-changed": "the port ran at {old} baud, runs at {new}: peers receive noise",
    "byte-order-changed": "the byte order was {old}, is {new}: numbers are misread",
    "check-changed": "the check was {old}, is {new}: each side rejects the other's frames",
    "command-removed": "the command {old} was removed, with its frames and its method",
    "constant-changed": "the constant was {old}, is {new}: the other side's frame is rejected",
    "encoding-changed": "the bytes were {old}, are {new}: numbers are misread",
    "accepted-changed": "the status of success was {old}, is {new}: refusals are misread",
    "event-changed": "whether the device sends it without a request: was {old}, is {new}",
    "echo-changed": "the echo was {old}, is {new}: replies are matched to requests differently",
    "enum-member-removed": "the member {old} was removed: frames that carry it are rejected",
    "enum-member-renumbered": "{old} became {new}: the member has another raw value",
    "footer-changed": "the footer was {old}, is {new}: each side rejects the other's frames",
    "layout-changed": "the layout was {old}, is {new}: each side rejects the other's frames",
    "header-changed": "the header was {old}, is {new}: neither side finds the other's frames",
    "id-changed": "the id was {old}, is {new}: the request reaches another command, or none",
    "items-changed": "the parts were {old}, are {new}: numbers are misread or rejected",
    "not-finite-changed": "was {old}, is {new}: replies with NaN are rejected, or accepted",
    "reply-added": "there was no reply, now there is {new}: old peers never send it",
    "reply-variant-changed": "the reply was ({old}), is ({new}): misread or rejected",
    "reply-removed": "the reply {old} was removed: replies of old peers are rejected",
    "request-variant-removed": "the request ({old}) is now rejected: old peers send it",
    "request-variant-changed": "the request was ({old}), is ({new}): misread or rejected",
    "result-added": "the reply now carries {new}: replies of old peers are rejected",
    "result-removed": "the reply no longer carries {old}: replies of old peers are rejected",
    "scale-changed": "the scale was {old}, is {new}: the same bytes are another value",
    "selector-changed": "the selector was {old}, is {new}: numbers are misread",
    "shape-changed": "was {old}, is {new}: values are misread or rejected",
    "sign-rule-changed": "raw values were {old}, are {new}: some are misread",
    "text-changed": "the text was `{old}`, is `{new}`: it is misread",
    "type-bytes-changed": "was {old} on the wire, is {new}: the frame is misread or rejected",
    "unit-changed": "the unit was {old}, is {new}: the same number means something else",
    "width-changed": "bytes were {old}, are {new}: the frame is rejected",
}
_API = {
    "alias-removed": "the method {old} was removed; its message remains as {new}",
    "argument-now-required": "was optional, is required",
    "argument-order-changed": "the arguments were ({old}), are ({new})",
    "argument-renamed": "the argument {old} is now {new}",
    "argument-type-changed": "the argument took {old}, takes {new}",
    "class-removed": "the class {old} was removed",
    "class-renamed": "the class {old} is now {new}",
    "command-renamed": "the method {old} is now {new}; its message stays the same",
    "default-removed": "was {old} if left out, must be given",
    "edition-removed": "the edition {old} was removed",
    "edition-renamed": "the edition {old} is now {new}: it is imported by another name",
    "enum-member-renamed": "the member {old} is now {new}; its raw value stays the same",
    "enum-member-truth-changed": "it was {old} in a condition, is {new}: callers branch otherwise",
    "item-renamed": "the part {old} is now {new}; its position stays the same",
    "radians-changed": "callers used {old}, use {new}: the same number is another angle",
    "result-now-optional": "was always present, may be missing",
    "result-renamed": "the result {old} is now {new}",
    "result-type-changed": "callers got {old}, get {new}",
    "type-kind-changed": "the kind was {old}, is {new}: callers pass or get another type",
}
_BEHAVIOUR = {
    "address-joints-changed": "the joints of the device were {old}, are {new}",
    "agreement-changed": "agreed with {old}, agrees with {new}: runs compare other queries",
    "effect-changed": "it did: {old}; it does: {new}",
    "samples-changed": "a conformance run sent {old}, sends {new}",
    "ack-changed": "whether it has an acknowledgement: was {old}, is {new}",
    "choices-narrowed": "legal raw values were {old}, are {new}: some are now rejected",
    "choices-widened": "legal raw values were {old}, are {new}: an old peer rejects some",
    "deadline-changed": "the deadline of the reply was {old} ms, is {new} ms",
    "default-changed": "was {old} if left out, is {new}: the same call sends another value",
    "motion-changed": "the motion was {old}, is {new}",
    "geometry-changed": "the geometry was {old}, is {new}",
    "encoders-changed": "the encoders were {old}, are {new}",
    "gripper-changed": "the simulated gripper was {old}, is {new}",
    "servos-changed": "the servos were {old}, are {new}",
    "error-codes-changed": "the numbers of rejected motions were {old}, are {new}",
    "joint-limits-changed": "the limits of the joints were {old}, are {new}",
    "start-angles-changed": "a simulated arm began at {old}, begins at {new}",
    "state-changed": "the state was {old}, is {new}",
    "joints-changed": "the arm had {old} joints, has {new}",
    "maximum-data-changed": "a frame carried up to {old} data bytes, carries {new}",
    "range-moved": "the range was {old}, is {new}: values on either side are rejected",
    "range-narrowed": "the range was {old}, is {new}: values outside the new one are now rejected",
    "range-widened": "the range was {old}, is {new}: an old peer rejects more values",
    "role-changed": "the role was {old}, is {new}: waits and limits apply to other commands",
    "safety-changed": "was {old}, is {new}: retries and conformance runs treat it differently",
    "selector-added": "its type now depends on {new}; the effects are listed separately",
    "selector-removed": "its type depended on {old}; the effects are listed separately",
    "shared-id-order-changed": "the first of these commands names a frame: was {old}, is {new}",
    "silence-changed": "the text ended after {old} ms of silence, ends after {new} ms",
}
_PEER = {
    "enum-member-added": "the member {new} was added: an old peer does not know it",
    "reply-variant-added": "the reply may also be ({new}): an old client rejects it",
    "reply-variant-removed": "the reply ({old}) is now rejected: an old device sends it",
}
_ADDITION = {
    "address-added": "the address {new} was added",
    "argument-added-optional": "the request may now carry {new}",
    "argument-now-optional": "was required, is optional",
    "argument-type-widened": "the argument took {old}, now takes {new}",
    "class-added": "the class {new} was added",
    "command-added": "the command {new} was added",
    "default-added": "may be left out, and is then {new}",
    "echo-loosened": "the echo was {old}, is {new}: replies without it are accepted as well",
    "edition-added": "the edition {new} was added",
    "request-variant-added": "the request may also be ({new})",
    "state-added": "the state was added, is {new}",
    "result-now-required": "could be missing, is always present",
}
_DOCS = {
    "address-renamed": "the address {old} is now called {new}",
    "alias-changed": "its message was {old}, is {new}",
    "arguments-restated": "the order of the arguments is stated as ({new}), but is as before",
    "base-changed": "the base was {old}, is {new}; the effects are listed separately",
    "command-moved": "was in the family {old}, is in {new}",
    "dispute-added": "now disputed: {new}",
    "dispute-changed": "a dispute changed: {new}",
    "dispute-removed": "no longer disputed: {old}",
    "doc-changed": "was: {old}; is: {new}",
    "erratum-added": "a new erratum: {new}",
    "erratum-changed": "an erratum changed: {new}",
    "erratum-removed": "an erratum was removed: {old}",
    "evidence-added": "new evidence: {new}",
    "evidence-changed": "the evidence changed: {new}",
    "evidence-removed": "evidence was removed: {old}",
    "family-added": "the family {new} was added",
    "family-removed": "the family {old} was removed; its commands are listed separately",
    "family-renamed": "the family {old} is now {new}, and so is its page",
    "firmware-changed": "the firmware was {old}, is {new}",
    "history-changed": "the descriptions of the changes differ: {new}",
    "meanings-changed": "the meanings were ({old}), are ({new})",
    "note-changed": "the notes changed: {new}",
    "order-changed": "the order was {old}; is {new}",
    "range-restated": "the range is {new}, as before, but stated differently",
    "sharing-changed": "the commands that share an id were {old}, are {new}",
    "source-changed": "the source was {old}, is {new}",
    "type-added": "the type {new} was added",
    "type-removed": "the type {old} was removed",
    "type-renamed": "the type {old} is now called {new}, only in the spec",
    "type-replaced": "used {old}, uses {new}; the effects are listed separately",
    "versions-changed": "the firmware that it needs was ({old}), is ({new})",
    "vector-added": "a vector for {new} was added",
    "vector-changed": "the vector changed: {new}",
    "vector-removed": "a vector for {old} was removed",
}
_TABLES: dict[Level, dict[str, str]] = {
    "wire": _WIRE,
    "api": _API,
    "behaviour": _BEHAVIOUR,
    "peer": _PEER,
    "addition": _ADDITION,
    "docs": _DOCS,
}

RULES = {
    rule: Rule(level, message)
    for level, rules in _TABLES.items()
    for rule, message in rules.items()
}
