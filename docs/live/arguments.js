// Turn the texts of a form into the arguments of a command; the codec checks their ranges.

export function values(form, texts) {
  const given = Object.entries(texts).filter(([, text]) => text);
  return Object.fromEntries(
    given.map(([name, text]) => {
      const argument = form.arguments.find((each) => each.name === name);
      if (!argument) throw new Error(`${form.name}() has no argument ${name}`);
      return [name, value(argument, text)];
    }),
  );
}

function value({ name, kind, many, list, rows, elements }, text) {
  if (kind === "text") return list ? text.split(",").filter(Boolean) : text;
  if (kind === "bytes") return bytes(name, text);
  if (kind === "flag") {
    if (text !== "on" && text !== "off") throw new Error(`${name} is ${text}; allowed: on or off`);
    return text === "on";
  }
  const scale = elements[0]?.unit === "radians" ? 180 / Math.PI : 1;
  const number = (word) => {
    const found = Number(word);
    if (!word.trim() || !Number.isFinite(found)) throw new Error(`${name} is ${JSON.stringify(word)}; allowed: a number`);
    return scale === 1 ? found : found * scale;
  };
  if (rows) return text.split(";").map((row) => row.split(",").map(number));
  return many || list ? text.split(",").map(number) : number(text);
}

function bytes(name, text) {
  const digits = text.replaceAll(/\s/g, "");
  if (!/^([\da-f]{2})*$/i.test(digits)) throw new Error(`${name} is ${JSON.stringify(text)}; allowed: pairs of hex digits`);
  return Uint8Array.from(digits.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));
}
