// Changed values as a mechanism file has them: lines of `parameters:`, or the whole file with them in it.

const QUANTITY = /^\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(\s*)(.*?)\s*$/s;

/** A value as it stands in a file: with the unit that it was written with, if that is the file's own, or has none. */
export function written({ unit, text }, value) {
  const [, space, word] = QUANTITY.exec(text ?? "") ?? [];
  // a bare number is in the file's own unit; what was written in another one, or as an expression, gets this one
  if (word === "" || !unit) return number(value);
  return `${number(value)}${word === unit ? space || " " : " "}${unit}`;
}

const number = (value) => String(value === 0 ? 0 : value);

/** The changed parameters as lines of YAML, or all of them where none is changed. */
export function parameterLines(dimensions) {
  const { parameters, values } = dimensions;
  const changed = parameters.filter(({ name }) => dimensions.isChanged(name));
  const lines = (changed.length > 0 ? changed : parameters).map((each) => `  ${each.name}: ${written(each, values[each.name])}`);
  return `parameters:\n${lines.join("\n")}\n`;
}

/** The text of the file with the changed values in it; all else is as it was. */
export function changedFile({ text, spans }, dimensions) {
  const { parameters, values } = dimensions;
  const changes = parameters
    .filter(({ name }) => dimensions.isChanged(name) && spans[name])
    .map((each) => ({ span: spans[each.name], value: written(each, values[each.name]) }))
    .sort((a, b) => b.span[0] - a.span[0]);
  // spans count characters, of which some are two of this language's
  let characters = Array.from(text);
  for (const { span: [start, end], value } of changes) characters = [...characters.slice(0, start), value, ...characters.slice(end)];
  return characters.join("");
}
