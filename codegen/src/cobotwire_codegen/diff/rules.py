"""Every rule: its id, its level and its message. Ids are stable; messages may improve.

A difference with several aspects has the level of the most severe one. A removed command, for
example, breaks both the protocol and its callers; its level is ``wire``.
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
    "address-replies-changed": "`replies` changed from {old} to {new}: replies are mismatched",
    "addresses-changed": (
        "the addresses changed from ({old}) to ({new}): frames reach other devices, or none"
    ),
    "argument-added-required": "the request now carries {new}: callers must pass it",
    "argument-removed": "the request no longer carries {old}: callers cannot pass it",
    "baudrate-changed": "the baud rate changed from {old} to {new}: peers receive noise",
    "byte-order-changed": "the byte order changed from {old} to {new}: numbers are misread",
    "check-changed": "the check changed from {old} to {new}: each side rejects the other's frames",
    "command-removed": "the command {old} was removed, with its frames and its method",
    "constant-changed": "the constant changed from {old} to {new}: peers reject the frames",
    "encoding-changed": "the encoding changed from {old} to {new}: numbers are misread",
    "accepted-changed": "success changed from {old} to {new}: refusals are misread",
    "event-changed": "whether the device sends it without a request changed from {old} to {new}",
    "echo-changed": "the echo changed from {old} to {new}: replies are matched differently",
    "enum-member-removed": "the member {old} was removed: frames that carry it are rejected",
    "enum-member-renumbered": "{old} became {new}: the member has another raw value",
    "footer-changed": "the footer changed from {old} to {new}: peers reject each other's frames",
    "layout-changed": "the layout changed from [{old}] to [{new}]: frames are rejected",
    "header-changed": "the header changed from {old} to {new}: peers take the frames for noise",
    "id-changed": "the id changed from {old} to {new}: requests reach another command, or none",
    "items-changed": "the parts changed from ({old}) to ({new}): numbers are misread or rejected",
    "not-finite-changed": "legal values changed from {old} to {new}: one side rejects NaN",
    "reply-added": "there was no reply, now there is {new}: old peers never send it",
    "reply-variant-changed": "the reply changed from ({old}) to ({new}): misread or rejected",
    "reply-removed": "the reply {old} was removed: replies of old peers are rejected",
    "request-variant-removed": "the request ({old}) is now rejected: old peers send it",
    "request-variant-changed": "the request changed from ({old}) to ({new}): misread or rejected",
    "result-added": "the reply now carries {new}: replies of old peers are rejected",
    "result-removed": "the reply no longer carries {old}: replies of old peers are rejected",
    "scale-changed": "the scale changed from {old} to {new}: the same bytes are another value",
    "selector-changed": "the selector changed from {old} to {new}: numbers are misread",
    "shape-changed": "the type changed from ({old}) to ({new}): values are misread or rejected",
    "sign-rule-changed": "raw values changed from {old} to {new}: some are misread",
    "text-changed": "the text changed from {old} to {new}: it is misread",
    "type-bytes-changed": "its size changed from {old} to {new}: the frame is misread or rejected",
    "unit-changed": "the unit changed from {old} to {new}: the same number means something else",
    "width-changed": "the number of bytes changed from {old} to {new}: the frame is rejected",
}
_API = {
    "alias-removed": "the method {old} was removed; its message remains as {new}",
    "argument-now-required": "it was optional, and is now required",
    "argument-order-changed": "the order of arguments changed from ({old}) to ({new})",
    "argument-renamed": "the argument {old} is now {new}",
    "argument-type-changed": "the argument's type changed from {old} to {new}",
    "class-removed": "the class {old} was removed",
    "class-renamed": "the class {old} is now {new}",
    "command-renamed": "the method {old} is now {new}; its message stays the same",
    "default-removed": "it had the default {old}, and is now required",
    "edition-removed": "the edition {old} was removed",
    "edition-renamed": "the edition {old} is now {new}: its import name changes",
    "enum-member-renamed": "the member {old} is now {new}; its raw value stays the same",
    "enum-member-truth-changed": "as a condition, it was {old}, and is now {new}",
    "item-renamed": "the part {old} is now {new}; its position stays the same",
    "radians-changed": "callers used {old}, now use {new}: the same number is another angle",
    "result-now-optional": "it was always present, and may now be missing",
    "result-renamed": "the result {old} is now {new}",
    "result-type-changed": "the result changed from ({old}) to ({new})",
    "type-kind-changed": "the kind changed from {old} to {new}: callers pass or get another type",
}
_BEHAVIOUR = {
    "address-joints-changed": "the joints of the device changed from {old} to {new}",
    "agreement-changed": "`agrees_with` changed from {old} to {new}: runs compare other queries",
    "effect-changed": "the effect changed from {old} to {new}",
    "samples-changed": "the numbers that a conformance run sends changed from ({old}) to ({new})",
    "ack-changed": "whether it has an acknowledgement changed from {old} to {new}",
    "choices-narrowed": "legal raw values changed from [{old}] to [{new}]: some are now rejected",
    "choices-widened": "legal raw values changed from [{old}] to [{new}]: an old peer rejects some",
    "deadline-changed": "the deadline of the reply changed from {old} ms to {new} ms",
    "default-changed": "the default changed from {old} to {new}: the same call sends another value",
    "motion-changed": "the motion changed from ({old}) to ({new})",
    "geometry-changed": "the geometry changed from ({old}) to ({new})",
    "encoders-changed": "the encoders changed from ({old}) to ({new})",
    "gripper-changed": "the simulated gripper changed from ({old}) to ({new})",
    "servos-changed": "the servos changed from ({old}) to ({new})",
    "error-codes-changed": "the error codes of rejected motions changed from ({old}) to ({new})",
    "joint-limits-changed": "the limits of the joints changed from {old} to {new}",
    "start-angles-changed": "the start angles of a simulated arm changed from {old} to {new}",
    "state-changed": "the state changed from ({old}) to ({new})",
    "joints-changed": "the number of joints changed from {old} to {new}",
    "maximum-data-changed": "the largest number of data bytes changed from {old} to {new}",
    "range-moved": "the range changed from {old} to {new}: each side rejects some values",
    "range-narrowed": "the range changed from {old} to {new}: some values are now rejected",
    "range-widened": "the range changed from {old} to {new}: an old peer rejects some values",
    "role-changed": "the role changed from {old} to {new}: other waits and limits apply",
    "safety-changed": "safety changed from {old} to {new}: retries and conformance runs differ",
    "selector-added": "its type now depends on {new}; the effects are listed separately",
    "selector-removed": "its type depended on {old}; the effects are listed separately",
    "shared-id-order-changed": (
        "a frame gets the name of the first of these commands: the order changed from ({old}) to "
        "({new})"
    ),
    "silence-changed": "the silence that ends the text changed from {old} ms to {new} ms",
}
_PEER = {
    "enum-member-added": "the member {new} was added: an old peer does not know it",
    "reply-variant-added": "the reply may also be ({new}): an old client rejects it",
    "reply-variant-removed": "the reply ({old}) is now rejected: an old device sends it",
}
_ADDITION = {
    "address-added": "the address {new} was added",
    "argument-added-optional": "the request may now carry {new}",
    "argument-now-optional": "it was required, and is now optional",
    "argument-type-widened": "the argument's type changed from {old} to {new}, which includes it",
    "class-added": "the class {new} was added",
    "command-added": "the command {new} was added",
    "default-added": "it is now optional, with the default {new}",
    "echo-loosened": "the echo changed from {old} to {new}: replies may lack it",
    "edition-added": "the edition {new} was added",
    "request-variant-added": "the request may also be ({new})",
    "state-added": "the state was added: {new}",
    "result-now-required": "it could be missing, and is now always present",
}
_DOCS = {
    "address-renamed": "the address {old} was renamed to {new}",
    "alias-changed": "`alias` changed from {old} to {new}",
    "arguments-restated": "the spec now states the order of arguments, ({new}), which is unchanged",
    "base-changed": "the base changed from {old} to {new}; the effects are listed separately",
    "command-moved": "it moved from the family {old} to {new}",
    "dispute-added": "now disputed: {new}",
    "dispute-changed": "a dispute changed: {new}",
    "dispute-removed": "no longer disputed: {old}",
    "doc-changed": "changed from {old} to {new}",
    "erratum-added": "a new erratum: {new}",
    "erratum-changed": "an erratum changed: {new}",
    "erratum-removed": "an erratum was removed: {old}",
    "evidence-added": "new evidence: {new}",
    "evidence-changed": "the evidence changed: {new}",
    "evidence-removed": "evidence was removed: {old}",
    "family-added": "the family {new} was added",
    "family-removed": "the family {old} was removed; its commands are listed separately",
    "family-renamed": "the family {old} was renamed to {new}; the address of its page changes too",
    "firmware-changed": "the firmware changed from {old} to {new}",
    "history-changed": "the delta describes its changes differently: {new}",
    "meanings-changed": "the meanings changed from ({old}) to ({new})",
    "note-changed": "the notes changed: {new}",
    "order-changed": "the order changed from ({old}) to ({new})",
    "range-restated": "the range is {new}, as before, but stated differently",
    "sharing-changed": "the commands that share the id changed from {old} to {new}",
    "source-changed": "the source changed from {old} to {new}",
    "type-added": "the type {new} was added",
    "type-removed": "the type {old} was removed",
    "type-renamed": "the type {old} was renamed to {new}; generated code stays the same",
    "type-replaced": "the type changed from {old} to {new}; the effects are listed separately",
    "versions-changed": "the required firmware changed from ({old}) to ({new})",
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
