"""A page that takes a third of its size, for notebooks, which keep one in every cell."""

from __future__ import annotations

import base64
import gzip

_UNPACK = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>replay</title></head><body><script>
(async () => {
  const bytes = Uint8Array.from(atob("PACKED"), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const page = await new Response(stream).text();
  document.open();
  document.write(page);
  document.close();
})().catch((cause) => {
  const help = "; run.save('run.html') writes it as a file.";
  document.body.textContent = "This browser cannot unpack the replay (" + cause + ")" + help;
});
</script></body></html>
"""


def packed(page: bytes) -> str:
    """HTML that unpacks an HTML `page` where it is shown; the same page gives the same text."""
    data = base64.b64encode(gzip.compress(page, 9, mtime=0)).decode("ascii")
    return _UNPACK.replace("PACKED", data)
