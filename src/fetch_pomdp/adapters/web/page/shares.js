// Shares of belief, by item.

const EQUAL = 0.02; // relative difference below which shares count as equal

export function allEqual(shares) {
  const values = Object.values(shares ?? {});
  return values.length > 1 && Math.min(...values) > Math.max(...values) * (1 - EQUAL);
}
