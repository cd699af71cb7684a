"""Describes ``spec/pymycobot.yaml``: how calls of the maker's library differ from ours."""

from __future__ import annotations

from cobotwire_codegen.language.names import CLASS, METHOD
from cobotwire_codegen.language.records import Listed, Named, Record, optional, required
from cobotwire_codegen.language.shapes import Names, Text, Texts, Word

# How a result is converted. The package has a function of each name.
RESULTS = {
    "plain": "Lists instead of tuples; numbers instead of flags and enums.",
    "listed": "A list, also of one number.",
    "nothing": "None; for requests with an acknowledgement.",
    "done": "1 when the request is sent; for requests without an acknowledgement.",
    "ended": "Waits for the end of the motion, and returns its status; 0 is success.",
    "bytes_listed": "The bytes in a list; a single one as a number.",
    "numbers": "The bytes in a list.",
    "tenths": "A tenth of the number.",
    "pairs": "A list of pairs: two numbers in each inner list.",
    "calibrated": "1 if all are calibrated, else a number for each joint.",
    "bits_from_the_highest": "For each number, the list of the bits that are set, or 0.",
    "robot_status": "All in one list; for each error word the list of the bits that are set, or 0.",
    "quick_move_info": "The rows, two zeros, and the last six bytes.",
    "in_hundredths": "Whole numbers of hundredths.",
    "signed": "Words of two bytes as signed numbers.",
    "solved": "A list of angles; a text if there is no solution.",
    "hex_text": "Four hex digits.",
    "calibrated_joints": "1 if everything is calibrated, else all numbers in one list.",
    "robot_status_of_450": "As `robot_status`, lowest bits first.",
    "flat": "All numbers in one list.",
    "in_thousandths": "Whole numbers of thousandths.",
    "servo_register": "The number; 255 means that the read failed.",
    "listed_hundredths": "A list of one whole number of hundredths.",
    "joined": "The parts of all named tuples in one list.",
    "radians": "Radians, rounded to thousandths.",
    "bit_numbers": "For each number the list of the bits that are set, lowest first, or 0.",
    "error_classes": "For each of seven bytes the bits of its class; six bytes as three words.",
    "points": "Two lists, of the numbers at even and at odd positions; -1 if all are 0.",
    "words_of_text": "The first word of the first text, and the last word of the last.",
}

# What one-way requests of a class return, if the edition may acknowledge them.
ONE_WAY = {
    "acknowledged": "1 once the acknowledgement has come.",
    "sent": "1 once the request is sent.",
    "listed": "A list with 1 once the request is sent.",
}


class Method(Record):
    """A method of the library, as far as it differs from ours."""

    parameters = optional(Texts(), "All parameters in their order: `name`, or `name=default`.")
    calls = optional(Text(), "Our method; left out: that of the same name.")
    passes = optional(
        Texts(),
        "The parameters that are passed to our method, in its order; a number in quotes is passed "
        "as it is. Left out: all but `_async` and those of `addresses` and `lacks`.",
    )
    lacks = optional(
        Names(), "Parameters that the edition cannot send; an error says so, unless they are None."
    )
    ranges = optional(
        Texts(), "Ranges that the library has and the edition lacks: `name=lowest..highest`."
    )
    result = optional(Word(RESULTS, RESULTS.values()), "How the result is converted.", "plain")


class Absent(Record):
    """Names without a counterpart; an error that says why is raised where one is used."""

    names = required(Names(), "The names.")
    why = required(Text(), "Why.")


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
    like = optional(Text(), "The class that it inherits from, with its methods.")
    methods_of = optional(
        Text(), "A class for another edition: what it states about methods holds here too."
    )
    helpers = optional(
        Names(), "Classes of the layer with methods of several requests: `Name`, or `module.Name`."
    )
    lacks = optional(Names(), "Our methods that the class does not have under our name.")
    addresses = optional(
        Names(), "The parameters of its methods that select the device that a request goes to."
    )
    one_way = optional(
        Word(ONE_WAY, ONE_WAY.values()),
        "What its one-way requests return, and when.",
        "acknowledged",
    )
    absent = optional(Listed(Absent), "Public names of the class that have no counterpart.")
    methods = optional(Named(Method, METHOD), "Methods that differ from those of other classes.")
    doc = required(Text(), "What the class is for.")


class Library(Record):
    """The maker's library."""

    library = required(Text(), "Its name and version.")
    methods = required(Named(Method, METHOD), "Methods of every class that does not state its own.")
    absent = required(Listed(Absent), "Public names of its classes that have no counterpart.")
    classes = required(Named(Class, CLASS), "Its classes, in the order of the documentation.")
