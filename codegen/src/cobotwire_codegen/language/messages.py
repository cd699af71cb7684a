"""The commands file: commands, their messages, and the fields of the messages."""

from __future__ import annotations

from cobotwire_codegen.language import facts
from cobotwire_codegen.language.effects import ANY_EFFECT_PART
from cobotwire_codegen.language.limits import COMMAND_LIMITS, NO_COMMAND, messages_by_key
from cobotwire_codegen.language.names import CASE, CLASS, LOWER, METHOD
from cobotwire_codegen.language.number_shapes import Numbers, Range, Real, Whole, WholeOrMember
from cobotwire_codegen.language.records import (
    Choice,
    Key,
    Listed,
    ListedTwice,
    Named,
    Part,
    Record,
    optional,
    required,
)
from cobotwire_codegen.language.shapes import Anything, Known, Name, Names, Text, Texts, Word, YesNo
from cobotwire_codegen.language.words import ROLES, SAFETY
from cobotwire_codegen.load import Node

_TYPE = Known("type_name", "the name of a type")


_NO_FIELDS = ("empty-list", "leave the key out")


class Case(Record):
    """The type of a field for one value of its selector."""

    type = required(_TYPE, "A quantity, flag, enum or value type.")
    EXAMPLE = "{type: rotation}"


class _Field(Record):
    name = required(Name(LOWER), "The name of the argument or result.")
    doc = optional(Text(), "What it is. Left out: the description of its type.")
    range = optional(Range(), "A range inside that of the type, in the type's unit.")
    optional_ = optional(YesNo(), "It may be left out. Only the last fields can be optional.")
    const = optional(
        WholeOrMember(),
        "The only raw value of the field, or the member of its enum; callers do not pass it.",
    )
    count = optional(
        Text(),
        "An earlier field that counts the elements of this one, if their number varies; callers do "
        "not pass it. Left out: the elements go to the end of the data.",
        "",
    )


class _ReplyField(_Field):
    echo = optional(
        Word(("required", "optional")),
        "The field repeats the request's field of the same name, and clients match the reply by "
        "it. `optional`: older firmware leaves it out, so both variants are legal.",
        "",
    )


class _Typed(Record):
    type = required(_TYPE, "A quantity, flag, enum or value type.")


class _Selected(Record):
    selector = required(
        Name(LOWER), "Another field of the message: an enum, or one with few whole numbers."
    )
    cases = required(
        Named(Case, CASE), "The type for each value of the selector: a member's name or a number."
    )


class RequestField(_Typed, _Field):
    """An argument of a request."""

    default = optional(
        Anything(
            "a value of the type, as a vector states it",
            {"type": ["number", "string", "boolean", "array"]},
        ),
        "The value that is sent if the caller leaves the argument out: a number in the type's "
        "unit, a member, true or false, or a list for a value type.",
    )
    EXAMPLE = '{name: speed, type: speed, doc: "How fast, in percent.", optional: true}'


class SelectedRequestField(_Selected, _Field):
    """An argument with a type that depends on the value of another argument, its selector."""

    EXAMPLE = """\
name: value
selector: axis
doc: The target of the axis.
cases:
  X: {type: length}
  RX: {type: rotation}
"""


class ReplyField(_Typed, _ReplyField):
    """A part of a reply."""

    EXAMPLE = "{name: joint, type: joint, echo: optional}"


class SelectedReplyField(_Selected, _ReplyField):
    """A part of a reply with a type that depends on the value of another part, its selector."""


ANY_REQUEST_FIELD = Choice("any_request_field", {"selector": SelectedRequestField}, RequestField)
ANY_REPLY_FIELD = Choice("any_reply_field", {"selector": SelectedReplyField}, ReplyField)
FIELDS: dict[str, Choice] = {"request": ANY_REQUEST_FIELD, "reply": ANY_REPLY_FIELD}


class TextField(Record):
    """A part of a text."""

    name = required(Name(LOWER), "Its name.")
    doc = required(Text(), "What it is.")
    EXAMPLE = "{name: ssid, doc: The name of the network.}"


class RequestText(Record):
    """Text that follows a request outside any frame."""

    text = required(Text(), "The text, with each field in braces: `word {field} word {field}`.")
    fields = optional(Listed(TextField), "The fields, in the order of the text.")
    EXAMPLE = """\
text: "'{account}'({password})"
fields:
  - {name: account, doc: The name of the network.}
  - {name: password, doc: Its password.}
"""


class ReplyText(RequestText):
    """A reply that is text outside any frame. It ends when no byte follows for a while."""

    class_ = required(Name(CLASS), "The class of the result in the generated Python.")
    silence_ms = required(Whole(1), "The silence that ends the text, in milliseconds.")
    EXAMPLE = """\
text: "ssid: {ssid} password: {password}"
silence_ms: 50
class: WifiAccount
fields:
  - {name: ssid, doc: The name of the network.}
  - {name: password, doc: Its password.}
"""


class Firmware(Record):
    """The versions of the device's firmware on which a command depends."""

    since = optional(Real(), "The first version that has the command.")
    until = optional(Real(), "The first version that lacks it again.")
    reply_since = optional(Real(), "The first version that replies to it.")
    evidence = required(
        Listed(facts.Evidence, facts.NO_EVIDENCE), "What each source states.", facts.NO_EVIDENCE[0]
    )
    EXAMPLE = """\
since: 7.4
evidence:
  - {source: the maker's library 4.0.7, says: "needs 7.4"}
"""


def accepted_key() -> Key[Node | None]:
    """Return the key for the status values that mean success."""
    return optional(
        Anything(
            "a list of members or raw numbers",
            {"type": "array", "items": {"type": ["string", "integer"]}, "minItems": 1},
        ),
        "The values of the last field of the reply that report success; with any other one the "
        "device has refused the request, or a motion has failed. Left out: every value except 0.",
    )


class Command(Record):
    """A command: its id, its request and its reply. The key in `commands` names its method."""

    id = required(Whole(0, 0xFFFF, "bad-id"), "CMD, the number that identifies the command.")
    title = required(Text(), "A heading.")
    doc = required(Text(), "One or two sentences about what it does.")
    safety = required(
        Word(SAFETY, SAFETY.values()), "What may be repeated, and what a conformance run may send."
    )
    source = facts.source()
    request = optional(
        Listed(ANY_REQUEST_FIELD, _NO_FIELDS), "The data that is sent. Left out: none."
    )
    request_variants = optional(
        ListedTwice(ANY_REQUEST_FIELD),
        "The variants of the request, the full one first, if they differ in more than optional "
        "fields at the end. Decoders distinguish them by length, then by constants. The arguments "
        "of a call choose the variant, so no two variants may have the same arguments.",
    )
    arguments = optional(
        Names(),
        "The names of all arguments in the order of the method, if it is not that of the wire. "
        "Arguments that can be left out come last.",
    )
    reply = optional(
        Listed(ANY_REPLY_FIELD, _NO_FIELDS), "The data of the reply. Left out: no reply."
    )
    reply_variants = optional(
        ListedTwice(ANY_REPLY_FIELD), "The variants of the reply, the full one first."
    )
    reply_text = optional(Part(ReplyText), "The reply, if it is text outside any frame.")
    request_text = optional(Part(RequestText), "Text that follows the request.")
    ack = optional(
        YesNo(),
        "The reply is an acknowledgement: it may come, come late or never, and clients do not wait "
        "for it.",
    )
    event = optional(
        YesNo(),
        "The device sends the reply without a request: clients have a typed event instead of a "
        "method. Its safety is `query`.",
    )
    accepted = accepted_key()
    alias = optional(
        Name(METHOD), "The command that has the same message, of which this is a second name."
    )
    role = optional(
        Word(ROLES, ROLES.values()), "How hand-written code finds the command in every edition.", ""
    )
    effect = optional(
        ANY_EFFECT_PART,
        "What the command does. A role that implies the effect replaces the key. Left out: not "
        "stated; a simulated arm sends a legal reply, and its state does not change.",
    )
    agrees_with = optional(Names(), "Queries that report the same values while the arm rests.")
    samples = optional(
        Anything(
            "a list of mappings from an argument to its raw values",
            {"type": "array", "items": Named(Numbers(), LOWER).schema()},
        ),
        "The raw values that a conformance run may send if not every legal one is harmless. An "
        "entry applies to the first variant of the request that has its arguments.",
    )
    shares_id = optional(Names(), "Commands that have the same id with other data.")
    deadline_ms = optional(
        Whole(1), "How long a client waits for the reply. Left out: as the transport states.", 0
    )
    notes = optional(Texts(), "Sentences for the reference.")
    firmware = optional(
        Part(Firmware),
        "The firmware that it needs. A delta inherits none. Left out: no source names a version.",
    )
    disputed = facts.disputed()
    EXCLUSIVE = (
        ("request", "request_variants"),
        ("reply", "reply_variants"),
        ("event", "request"),
        ("event", "request_variants"),
        ("event", "request_text"),
        ("event", "ack"),
    )
    LIMITS = messages_by_key((*COMMAND_LIMITS, NO_COMMAND._replace(keys=("id",))))
    EXAMPLE = """\
id: 0x21
title: Send one joint to an angle
doc: Moves one joint to an angle.
safety: motion
source: [274-304]
role: joint target
request:
  - {name: joint, type: joint}
  - {name: angle, type: angle}
  - {name: speed, type: speed}
"""


class CommandsFile(Record):
    """A family of commands. A delta adds its commands to the base's family of the same name."""

    family = required(Name(LOWER), "The family's name; a module of the generated Python.")
    title = required(Text(), "A heading.")
    doc = required(Text(), "What the family contains.")
    commands = required(Named(Command, METHOD), "The commands by the names of their methods.")
