/** IRL text -> pieces with the class that colours them. */

const PIECE =
  /(\{[^}]*\}?|\(\*[\s\S]*?(?:\*\)|$))|('(?:[^'\n]|'')*'?|"(?:[^"\n]|"")*"?)|((?:\d+(?:\.(?!\.)\d*)?|\.\d+)(?:[eE][+-]?\d+)?)|([\p{L}_][\p{L}\p{N}_]*)/gu;

/** Lines of a program, each a list of [class or '', text]. */
export function colouredLines(text, keywords) {
  const words = new Set(keywords.map((word) => word.toUpperCase()));
  const lines = [[]];
  const add = (kind, piece) => {
    piece.split('\n').forEach((part, k) => {
      if (k) lines.push([]);
      if (part) lines[lines.length - 1].push([kind, part]);
    });
  };
  let end = 0;
  for (const found of text.matchAll(PIECE)) {
    add('', text.slice(end, found.index));
    const [piece, comment, string, number] = found;
    add(comment ? 'comment' : string ? 'string' : number ? 'number' : wordKind(piece, words), piece);
    end = found.index + piece.length;
  }
  add('', text.slice(end));
  return lines;
}

function wordKind(word, keywords) {
  if (keywords.has(word.toUpperCase())) return 'keyword';
  return word.startsWith('R_') ? 'system' : '';
}
