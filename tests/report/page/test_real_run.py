"""Pages of a run in a browser: what they draw is where the run says the tool is."""

import numpy as np
import pytest

import irlx

pytestmark = pytest.mark.req("REP-04")

CELL = '[robot]\nmodel = "rail6"\n[motion]\ntick_ms = 20\n'
TEXT = """PROGRAM p;
BEGIN
  WRITELN('</script><script>window.bad = 1</script>');
  MOVE_INC LIN (0, 30, -20);
  R_TOOL := POSE(POSITION(0, 20, 120), ORIXYZ(0, 20, 0));
  MOVE_INC LIN (0, -20, 0);
ENDPROGRAM;
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    (folder / "p.irl").write_text(TEXT, encoding="utf-8")
    return irlx.run(folder / "p.irl")


def test_forward_kinematics_of_the_page(run, open_page, tmp_path):
    run.save(tmp_path / "p.html")
    with open_page(tmp_path / "p.html", drawn=False) as shown:
        assert shown.run("() => irlx.frames") == len(run.t)
        poses = np.array(shown.run("() => irlx.data.frames.tick.map((_, k) => irlx.toolPose(k))"))
        assert shown.requests == [(tmp_path / "p.html").as_uri()]
        assert shown.run("() => window.bad") is None
    np.testing.assert_allclose(poses[:, :3], run.tool[:, :3], atol=1e-8)
    same = np.abs(np.sum(poses[:, 3:] * run.tool[:, 3:], axis=1))
    np.testing.assert_allclose(same, 1.0, atol=1e-12)


def test_a_cell_of_a_notebook(run, tab, tmp_path):
    (tmp_path / "cell.html").write_text(f"<body>{run._repr_html_()}</body>", encoding="utf-8")
    asked = []
    with tab() as page:
        page.on("request", lambda request: asked.append(request.url))
        page.goto((tmp_path / "cell.html").as_uri())
        (frame,) = page.frames[1:]
        frame.wait_for_function("() => window.irlx !== undefined")
        assert frame.evaluate("() => irlx.ready.then(() => irlx.frames)") == len(run.t)
        pose = frame.evaluate("() => irlx.toolPose(irlx.frames - 1)")
        assert page.get_by_role("rowheader", name="path error").is_visible()
        assert [url for url in asked if not url.startswith(("file:", "blob:", "data:", "about:"))] == []
    np.testing.assert_allclose(pose[:3], run.tool[-1, :3], atol=1e-8)
