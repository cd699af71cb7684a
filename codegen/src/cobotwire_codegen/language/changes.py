"""The changes file: what a delta changes in its base."""

from __future__ import annotations

from cobotwire_codegen.language.facts import NO_EVIDENCE, Evidence
from cobotwire_codegen.language.messages import (
    ANY_REPLY_FIELD,
    ANY_REQUEST_FIELD,
    Command,
    ReplyField,
    RequestField,
    SelectedReplyField,
    SelectedRequestField,
)
from cobotwire_codegen.language.names import LOWER, METHOD
from cobotwire_codegen.language.records import (
    Changed,
    Choice,
    Listed,
    Part,
    Record,
    optional,
    required,
)
from cobotwire_codegen.language.shapes import Name, Names, Text
from cobotwire_codegen.language.types import SECTIONS

_SET = "Keys with their new values."
_UNSET = "Keys that are left out in this edition."


class _AddField(Record):
    """Add a field."""

    after = optional(Text(), "The field that it follows. Left out: it becomes the last.")


class AddRequestField(_AddField):
    """Add a field to the request."""

    add = required(Part(ANY_REQUEST_FIELD), "The field.")
    EXAMPLE = "{add: {name: speed, type: speed}, after: encoder}"


class AddReplyField(_AddField):
    """Add a field to the reply."""

    add = required(Part(ANY_REPLY_FIELD), "The field.")


class RemoveField(Record):
    """Remove a field."""

    remove = required(Text(), "The field.")
    EXAMPLE = "{remove: speed}"


class RenameField(Record):
    """Rename a field."""

    rename = required(Text(), "The field.")
    to = required(Name(LOWER), "The new name.")
    EXAMPLE = "{rename: joint, to: servo}"


class _ChangeField(Record):
    change = required(Text(), "The field.")
    unset = optional(Names(), _UNSET)


class ChangeRequestField(_ChangeField):
    """Change a field of the request."""

    set = optional(Changed(RequestField, SelectedRequestField), _SET)
    EXAMPLE = "{change: joint, set: {type: servo}, unset: [doc]}"


class ChangeReplyField(_ChangeField):
    """Change a field of the reply."""

    set = optional(Changed(ReplyField, SelectedReplyField), _SET)


_BOTH: dict[str, type[Record]] = {"remove": RemoveField, "rename": RenameField}
REQUEST_CHANGE = Choice(
    "request_change", {"add": AddRequestField, **_BOTH, "change": ChangeRequestField}
)
REPLY_CHANGE = Choice("reply_change", {"add": AddReplyField, **_BOTH, "change": ChangeReplyField})
FIELD_CHANGES = {"request": REQUEST_CHANGE, "reply": REPLY_CHANGE}


class _Change(Record):
    why = required(Text(), "The reason.")
    evidence = required(Listed(Evidence, NO_EVIDENCE), "The sources that state it.", NO_EVIDENCE[0])


class RemoveCommands(_Change):
    """Remove commands of the base, with their vectors."""

    remove = required(Names(), "The commands.")
    EXAMPLE = """\
remove: [get_speed, set_speed]
why: The firmware no longer knows them.
evidence: [{source: a library 2.0, says: "it has no such method"}]
"""


class RenameCommand(_Change):
    """Rename a command of the base; its vectors then use the new name."""

    rename = required(Names(), "The command.")
    to = required(Name(METHOD), "The new name.")


class ChangeCommands(_Change):
    """Change commands of the base."""

    change = required(Names(), "The commands.")
    set = optional(Changed(Command), _SET)
    unset = optional(Names(), _UNSET)
    request = optional(Listed(REQUEST_CHANGE), "Changes of the request's fields, in order.")
    reply = optional(Listed(REPLY_CHANGE), "Changes of the reply's fields, in order.")
    EXAMPLE = """\
change: set_encoder
set: {doc: "Moves one joint to a position, at a speed."}
unset: [notes]
request:
  - {add: {name: speed, type: speed}, after: encoder}
why: The firmware expects a speed.
evidence: [{source: a library 2.0, says: "sends the speed after the position"}]
"""


class ChangeTypes(_Change):
    """Change types of the base."""

    change_type = required(Names(), "The types.")
    set = optional(Changed(*SECTIONS.values()), _SET)
    unset = optional(Names(), _UNSET)
    EXAMPLE = """\
change_type: signed_word
set: {signed_at: 32767}
why: The firmware uses two's complement.
evidence: [{source: a capture, says: "-180 degrees is B9 B0"}]
"""


class WithdrawVectors(_Change):
    """Withdraw vectors of the base that do not hold in this edition."""

    withdraw = required(Names(), "The vectors.")
    EXAMPLE = """\
withdraw: [example-31]
why: The example shows the older request.
evidence: [{source: a library 2.0, says: "sends two more bytes"}]
"""


class WithdrawAcks(_Change):
    """Withdraw the base's acknowledgement of commands, with its vectors.

    The commands then have no reply. If the edition has another rule for acknowledgements, state
    `acks` in it, which replaces that of the base.
    """

    withdraw_acks = required(Names(), "The commands, or `all`.")
    EXAMPLE = """\
withdraw_acks: all
why: The firmware sends nothing after a setter.
evidence: [{source: a library 2.0, says: "waits for no reply to setters"}]
"""


CHANGE = Choice(
    "change",
    {
        "remove": RemoveCommands,
        "rename": RenameCommand,
        "change": ChangeCommands,
        "change_type": ChangeTypes,
        "withdraw": WithdrawVectors,
        "withdraw_acks": WithdrawAcks,
    },
)


class ChangesFile(Record):
    """The changes of a delta to its base, in order. Changing what the base lacks is an error."""

    changes = required(Listed(CHANGE), "The changes.")
