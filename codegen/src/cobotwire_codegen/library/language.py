"""Describes ``spec/pymycobot.yaml``: how calls of the maker's library differ from ours."""

from __future__ import annotations

from cobotwire_codegen.language.names import CLASS, METHOD
from cobotwire_codegen.language.records import Listed, Named, Record, optional, required
from cobotwire_codegen.language.shapes import Names, Text, Texts, Word

# How a result is given. The package has a function of each name.
RESULTS = {
    "plain": "Lists instead of tuples; numbers instead of flags and enums.",
    "listed": "A list of one number.",
    "nothing": "None; for orders with an acknowledgement.",
    "done": "1 when the order is sent; for orders without an acknowledgement.",
    "ended": "The status with which the motion ended, which is waited for; 0 is success.",
    "joined": "The parts of all named tuples in one list.",
    "radians": "Radians, rounded to thousandths.",
    "bit_numbers": "For each byte the list of the bits that are set, or 0.",
    "error_classes": "For each of seven bytes the bits of its class; six bytes as three words.",
    "points": "Every second number in one list, the others in another; -1 if all are 0.",
    "words_of_text": "The first word of the first text, and the last word of the last.",
}


class Method(Record):
    """A method of the library, as far as it differs from ours."""

    parameters = optional(Texts(), "All parameters in their order: `name`, or `name=default`.")
    calls = optional(Text(), "Our method; left out: that of the same name.")
    passes = optional(
        Texts(),
        "The parameters that our method is given, in its order, or numbers in quotes instead; "
        "left out: all but `_async`.",
    )
    result = optional(Word(RESULTS, RESULTS.values()), "How the result is given.", "plain")


class Class(Record):
    """A class of the library."""

    module = required(Text(), "The module of the library that has the class.")
    edition = required(Text(), "Our edition whose client it calls.")
    ports = optional(Texts(), "The ports that have this edition; only with `elsewhere`.")
    elsewhere = optional(Text(), "The edition on all other ports; left out: the same.")
    constructor = required(
        Texts(), "The parameters of its constructor; the first two say what it opens."
    )
    opens = optional(Word(("serial", "socket")), "What its constructor opens.", "serial")
    like = optional(Text(), "A class of which it is a subclass: it has its methods.")
    methods_of = optional(
        Text(), "A class for another edition: what it states about methods holds here too."
    )
    helpers = optional(Names(), "Classes of the layer with methods of several requests.")
    lacks = optional(Names(), "Our methods that the class does not have under our name.")
    methods = optional(Named(Method, METHOD), "Methods that differ from those of other classes.")
    doc = required(Text(), "What the class is for.")


class Absent(Record):
    """Names of the library without a counterpart."""

    names = required(Names(), "The names.")
    why = required(Text(), "Why.")


class Library(Record):
    """The maker's library."""

    library = required(Text(), "Its name and version.")
    methods = required(Named(Method, METHOD), "Methods, where a class says nothing else.")
    absent = required(Listed(Absent), "Public names of its classes that have no counterpart.")
    classes = required(Named(Class, CLASS), "Its classes, in the order of the documentation.")
