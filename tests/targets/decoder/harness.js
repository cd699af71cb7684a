"use strict";
// Decode every vector with the page's own code, and write the results as JSON, for Python to judge.
(function () {
  const bytes = (text) => cobotwire.parse(text);
  const parts = {
    messages(record, table) {
      const readings = new cobotwire.Law(table, [record.direction]).read(bytes(record.bytes));
      const mine = readings.find(
        (each) => each.command.name === record.command && each.number === record.variant);
      const fields = mine && mine.fields.map(({ field, numbers }) => ({
        name: field.name,
        raw: numbers.map((each) => each.raw),
        value: numbers.map((each) => each.value),
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
  const table = cobotwire.tables[cobotwireVectors.edition];
  const found = {};
  for (const [part, judge] of Object.entries(parts)) {
    found[part] = cobotwireVectors[part].map((record) => {
      try {
        return judge(record, table);
      } catch (error) {
        return { error: String(error) };
      }
    });
  }
  const pre = document.createElement("pre");
  pre.id = "result";
  pre.textContent = JSON.stringify(found);
  document.body.append(pre);
})();
