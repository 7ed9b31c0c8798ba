// A row that is measured again, because the sensor runs faster than the stream, has noise of its own: as feed_vary in sim/model/feed.h
export function varied(rows, row, repeats) {
  const atRail = (lsb) => [512, 1024, 2048, 4096].includes(lsb < 0 ? -lsb : lsb + 1);
  const off = (all) => all.every((lsb) => lsb === -1);
  const readings = rows[row].slice(1);
  if (repeats === 0 || off(readings)) return readings;
  const turn = repeats + row + 1;
  for (const axis of [turn % 3, (turn + 1) % 3, (turn + 2) % 3]) {
    const lately = rows.slice(Math.max(0, row - 10), row + 1).map((each) => each[axis + 1]);
    const now = readings.map((lsb, i) => (i === axis ? lsb + (turn % 2 === 0 ? 1 : -1) : lsb));
    if (lately.some((lsb) => lsb !== lately[0]) && !atRail(readings[axis]) && !atRail(now[axis]) && !off(now)) return now;
  }
  return readings;
}
