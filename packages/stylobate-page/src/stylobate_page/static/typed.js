// What is typed into fields of numbers: told in the words of its field where it is none, before anything is asked for.

import { Refused } from "./api.js";

const NUMERAL = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
export const isNumeral = text => NUMERAL.test(text.trim()) && Number.isFinite(Number(text));

// A number as typed, without what is around it. "field" is marked where it is none; "such" is one that it may be.
export function numeral(text, field, label, { unit = "", such, whole = false } = {}) {
  const typed = String(text).trim(), what = `${whole ? "a whole number" : "a number"}${unit && ` [${unit}]`}`;
  if (isNumeral(typed) && (!whole || /^[+-]?\d+$/.test(typed))) return typed;
  const point = typed.replace(",", "."), mended = typed !== point && isNumeral(point) && !whole;
  const why = typed ? `is “${typed.slice(0, 60)}”; it must be ${what}` : `is empty; give ${what}`;
  throw new Refused(0, { error: `“${label}” ${why}${mended ? `, with a point: ${point}` : `, such as ${such}`}.`, field });
}

// The first and the last of several values, and how many of them.
export function range([low, high, count], field, labels, given) {
  const ends = [numeral(low, field, labels[0], given), numeral(high, `${field}.last`, labels[1], given)];
  const number = numeral(count, `${field}.number`, labels[2], { such: given.number, whole: true });
  if (Number(number) > 1 && Number(ends[0]) >= Number(ends[1])) {
    throw new Refused(0, { error: `“${labels[1]}” is ${ends[1]}; it must be above “${labels[0]}”, which is ${ends[0]}: make it larger.`, field: `${field}.last` });
  }
  return [...ends, number];
}
