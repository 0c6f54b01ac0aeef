/** Which lines of a program belong to one statement: a move may go on below the line that it begins on. */

/**
 * Of each line that is known to begin a move the last line of its statement, that of the next semicolon: Map line -> line.
 * `lines` are pieces [class or '', text] of each line: of comments and strings semicolons end nothing.
 */
export function lastLines(lines, begins) {
  const ends = lines.map((pieces) => pieces.some(([kind, text]) => kind === '' && text.includes(';')));
  return new Map(
    begins.map((line) => {
      const end = ends.indexOf(true, line - 1);
      return [line, end < 0 ? line : end + 1];
    }),
  );
}
