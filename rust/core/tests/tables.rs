//! A table that cannot be interpreted is rejected. Python makes no such table.

use crate::common::{field, frame_format, number};
use cobotwire_core::{Command, Field, Misfit, Number, Table, TableError, Variant};

fn misfit(fields: Vec<Field>) -> Result<(), TableError> {
    let command = Command {
        id: 1,
        request: vec![Variant::new(fields)],
        reply: vec![],
    };
    Table::new(frame_format(), vec![command]).map(drop)
}

#[test]
fn table_that_cannot_be_interpreted_is_rejected() {
    let word = || number(2, 1, -1, 1);
    let one = |number: Number| vec![field(vec![number], false)];
    let plain = || field(vec![word()], false);
    let without_cases = Field {
        cases: vec![],
        ..plain()
    };
    let selected_by_nothing = Field {
        selector: Some(1),
        ..plain()
    };
    let zero = Number {
        multiply: 0,
        ..word()
    };
    for (fields, misfit_of) in [
        (one(number(5, 1, 0, 1)), Misfit::Width),
        (one(number(1, 0, 0, 1)), Misfit::Scale),
        (one(zero), Misfit::Scale),
        (one(number(1, 1 << 54, 0, 1)), Misfit::Scale),
        (one(number(1, 1, 0, i64::MAX)), Misfit::Bounds),
        (one(number(1, 1, i64::MIN, 0)), Misfit::Bounds),
        (vec![without_cases], Misfit::Cases),
        (vec![field(vec![word(), word()], false)], Misfit::Cases),
        (vec![selected_by_nothing], Misfit::Selector),
        (vec![field(vec![word(); 127], true)], Misfit::Length),
    ] {
        let expected = TableError {
            command: 0,
            misfit: misfit_of,
        };
        assert_eq!(misfit(fields), Err(expected));
    }
}
