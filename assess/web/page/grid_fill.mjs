// What the fill handle writes: a series that goes on, or copies.

const TRAILING = /^(.*?)(\d+)$/s;

/**
 * Values that continue some others.
 * @param {Array<*>} source values that were selected, in order away from which is filled
 * @param {number} count how many to make
 * @param {{back?: boolean, other?: boolean}} [how] `back`: towards the first row; `other`: a series in place of copies, or copies in place of one
 */
export function continueSeries(source, count, { back = false, other = false } = {}) {
  const from = back ? [...source].reverse() : source;
  const series = findSeries(from, other);
  return Array.from({ length: count }, (_, i) => (series ? series(i + 1) : from[i % from.length]));
}

/** A function from 1, 2, ... to the values after the last, or null where they are to be copied. */
function findSeries(values, other) {
  const numbers = values.map((value) => (typeof value === "number" ? value : null));
  if (numbers.every((value) => value !== null)) {
    if (values.length === 1) return other ? count(numbers, 1, (n) => n) : null; // one height is copied, as in Excel
    const step = stepOf(numbers);
    return step === null || other ? null : count(numbers, step, (n) => n);
  }
  if (other) return null;
  const parts = values.map((value) => TRAILING.exec(String(value ?? "")));
  if (parts.some((part) => part === null || part[1] !== parts[0][1] || part[2].length > 9)) return null;
  const ends = parts.map((part) => Number(part[2]));
  const step = ends.length === 1 ? 1 : stepOf(ends);
  const width = parts[0][2].startsWith("0") ? parts[0][2].length : 0;
  if (step === null) return null;
  return count(ends, step, (n) => (n < 0 ? null : parts[0][1] + String(n).padStart(width, "0")));
}

function stepOf(numbers) {
  const step = numbers[1] - numbers[0];
  const isEven = numbers.every((n, i) => i === 0 || Math.abs(n - numbers[i - 1] - step) < 1e-9 * (1 + Math.abs(step)));
  return isEven ? step : null;
}

const count = (numbers, step, write) => (i) => write(Number((numbers.at(-1) + step * i).toPrecision(12)));
