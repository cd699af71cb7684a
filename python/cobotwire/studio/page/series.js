// Samples over time in memory of a fixed size.

// Keeps rows of numbers. When it is full, the older half is kept at half its resolution, so that
// the whole session stays visible, and memory stays the same.
export class Series {
  constructor(width, capacity = 24000) {
    this.capacity = capacity;
    this.length = 0;
    // The usual seconds between two rows.
    this.usual = 0;
    this.times = new Float64Array(capacity);
    this.columns = Array.from({ length: width }, () => new Float64Array(capacity));
  }

  clear() {
    this.length = this.usual = 0;
  }

  // Add a row. After a silence a row without numbers comes first, so that no line crosses it.
  push(time, row) {
    const since = this.length ? time - this.times[this.length - 1] : 0;
    if (isGap(since, this.usual)) this.append(time - since / 2, []);
    else if (since > 0) this.usual = this.usual ? 0.9 * this.usual + 0.1 * since : since;
    this.append(time, row);
  }

  append(time, row) {
    if (this.length === this.capacity) this.thin();
    this.times[this.length] = time;
    this.columns.forEach((column, index) => (column[this.length] = row[index] ?? NaN));
    this.length += 1;
  }

  thin() {
    const half = this.capacity >> 1;
    const [numbers] = this.columns;
    // Keep every second row; if the row between marks a gap, keep that instead.
    const kept = Uint32Array.from({ length: half >> 1 }, (_, at) => 2 * at + Number.isNaN(numbers[2 * at + 1]));
    for (const column of [this.times, ...this.columns]) {
      kept.forEach((from, at) => (column[at] = column[from]));
      column.copyWithin(half >> 1, half, this.capacity);
    }
    this.length = this.capacity - half + (half >> 1);
  }

  // Return the index of the first row at a time or after it.
  find(time) {
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // Return times and columns from a time on, as arrays of at most about `most` points. Each pair
  // of points has the lowest and the highest value of its segment, so that no peak is lost.
  since(time, most) {
    const first = Math.max(0, this.find(time) - 1);
    const count = this.length - first;
    if (count <= most) {
      const cut = (column) => Array.from(column.subarray(first, this.length), finite);
      return [cut(this.times), ...this.columns.map(cut)];
    }
    const segments = most >> 1;
    const found = [[], ...this.columns.map(() => [])];
    for (let part = 0; part < segments; part++) {
      const begin = first + Math.floor((count * part) / segments);
      const end = first + Math.floor((count * (part + 1)) / segments);
      found[0].push(this.times[begin], (this.times[begin] + this.times[end - 1]) / 2 + 1e-9);
      this.columns.forEach((column, index) => {
        let low = Infinity;
        let high = -Infinity;
        for (let at = begin; at < end; at++) {
          if (column[at] < low) low = column[at];
          if (column[at] > high) high = column[at];
        }
        found[index + 1].push(finite(low), finite(high));
      });
    }
    return found;
  }
}

// Return whether two samples that are `seconds` apart have a gap between them.
// `inspect/plot/series.py` has the same rule.
export const isGap = (seconds, usual) => seconds > Math.max(1, 4 * usual);

const finite = (value) => (Number.isFinite(value) ? value : null);
