/** A line of a file, or the number of lines that are left out. */
export type Excerpt = { number: number; text: string } | { left: number };

const maxLines = 2000;
const around = 3;

/** The lines of a file; of a long one only its first lines and those around the marked ones. */
export function excerptOf(text: string, marked: Set<number | null>): Excerpt[] {
  const lines = text.split("\n");
  const all = lines.map((text, i) => ({ number: i + 1, text }));
  if (lines.length <= maxLines) return all;
  const kept = new Set<number>();
  for (const line of [1, ...marked])
    if (line !== null) for (let i = line - around; i <= line + around; i++) kept.add(i);
  const excerpt: Excerpt[] = [];
  let last = 0;
  for (const line of all.filter(({ number }) => kept.has(number))) {
    if (line.number > last + 1) excerpt.push({ left: line.number - last - 1 });
    excerpt.push(line);
    last = line.number;
  }
  if (last < lines.length) excerpt.push({ left: lines.length - last });
  return excerpt;
}
