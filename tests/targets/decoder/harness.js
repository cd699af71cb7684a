"use strict";
// Decode every vector with the page's own code, and write the results as JSON, for Python to validate.
(function () {
  const bytes = (text) => cobotwire.parse(text);
  const parts = {
    messages(record, table) {
      const readings = new cobotwire.Law(table, [record.direction]).read(bytes(record.bytes));
      const mine = readings.find(
        (each) => each.command.name === record.command && each.number === record.variant);
      const fields = mine && mine.fields.map(({ field, numbers, text }) => ({
        name: field.name,
        text,
        raw: numbers.map((each) => String(each.raw)),
        value: numbers.map((each) => (Number.isFinite(each.value) ? each.value : String(each.value))),
      }));
      return { read_as: readings[0].command.name, fields };
    },
    malformed(record, table) {
      try {
        new cobotwire.Law(table, [record.direction]).read(bytes(record.bytes));
      } catch (error) {
        return { reason: error.reason, offset: error.offset };
      }
      return {};
    },
    streams(record, table) {
      const listening = record.direction === "both" ? ["request", "reply"] : [record.direction];
      return new cobotwire.Law(table, listening).cut(bytes(record.bytes));
    },
  };
  const found = cobotwireVectors.map((document) => {
    const table = cobotwire.tables[document.edition];
    return Object.fromEntries(Object.entries(parts).map(([part, validate]) => [part, document[part].map((record) => {
      try {
        return validate(record, table);
      } catch (error) {
        return { error: String(error) };
      }
    })]));
  });
  const pre = document.createElement("pre");
  pre.id = "result";
  pre.textContent = JSON.stringify(found);
  document.body.append(pre);
})();
