// The engine of VS Code: reads {"grammar": path, "texts": [text, ..]} from stdin and writes, for each text, its
// lines, each a list of [start, end, innermost scope].
const fs = require("fs");
const { Registry, parseRawGrammar, INITIAL } = require("vscode-textmate");
const oniguruma = require("vscode-oniguruma");

async function main() {
  const asked = JSON.parse(fs.readFileSync(0, "utf-8"));
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.length));
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => parseRawGrammar(fs.readFileSync(asked.grammar, "utf-8"), asked.grammar),
  });
  const grammar = await registry.loadGrammar("source.irl");
  const found = asked.texts.map((text) => {
    let stack = INITIAL;
    return text.split("\n").map((line) => {
      const result = grammar.tokenizeLine(line, stack);
      stack = result.ruleStack;
      return result.tokens.map((one) => [one.startIndex, one.endIndex, one.scopes[one.scopes.length - 1]]);
    });
  });
  process.stdout.write(JSON.stringify(found));
}

main();
