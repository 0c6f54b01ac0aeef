"""The replay page in a browser: what it shows, asks for and answers to."""

import numpy as np
import pytest

from made_page import FRAMES, tool_poses

DARKER = 60
"""How much darker at least the dark page is than the light one, of 255."""


def test_small_variant(made, open_page):
    with open_page(made(small=True), width=700, height=420) as page:
        assert not page.page.locator("#program").is_visible()
        assert page.page.locator(".plot:visible").count() == 1
        page.page.get_by_label("Curve", exact=True).select_option(label="Path speed")
        assert page.page.locator(".plot:visible").get_attribute("data-plot") == "path"
        page.seek(30)
        assert page.colours("#scene > canvas")["different"] > 300
        assert page.run("() => document.documentElement.scrollHeight") <= 420


def test_the_scene_is_drawn_and_moves_and_is_light_and_dark_too(made, open_page):
    with open_page(made(), width=700, height=420) as page:
        pictures = []
        for frame in (0, FRAMES - 1, 0):
            page.seek(frame)
            pictures.append(page.colours("#scene > canvas"))
        assert pictures[0]["different"] > 500
        assert pictures[0]["hash"] != pictures[1]["hash"]
        assert pictures[0]["hash"] == pictures[2]["hash"]
        page.page.keyboard.press("t")
        assert page.run("() => document.documentElement.dataset.theme") == "dark"
        dark = np.array(page.colours("#scene > canvas")["mean"])
        page.page.keyboard.press("t")
        assert page.run("() => document.documentElement.dataset.theme") == "light"
        assert (np.array(page.colours("#scene > canvas")["mean"]) - dark).min() > DARKER


def test_keys(made, open_page):
    with open_page(made(), drawn=False) as page:
        press = page.page.keyboard.press
        steps = (
            ("ArrowRight", 1),
            ("ArrowRight", 2),
            ("ArrowLeft", 1),
            ("Shift+ArrowRight", 51),
            ("Shift+ArrowRight", FRAMES - 1),
            ("Shift+ArrowLeft", 51),
            ("Home", 0),
            ("End", FRAMES - 1),
        )
        for key, frame in steps:
            press(key)
            assert page.run("() => irlx.frame") == frame, key
        press("]")
        assert page.page.locator("#speed").input_value() == "2"
        press("[")
        assert page.page.locator("#speed").input_value() == "1"
        press("t")
        assert page.run("() => document.documentElement.dataset.theme") == "dark"
        press("?")
        assert page.page.get_by_role("dialog").is_visible()
        press("Escape")
        for _ in range(3):
            press("[")
        press("Home")
        press("Space")
        page.page.wait_for_function("() => irlx.frame > 5")
        press("Space")
        frame = page.run("() => irlx.frame")
        page.page.wait_for_timeout(150)
        assert page.run("() => irlx.frame") == frame
        # On the slider itself the same keys go the same ways.
        page.page.locator("#slider").focus()
        press("Home")
        press("ArrowRight")
        assert page.run("() => irlx.frame") == 1


def test_playing_ends_and_loops(made, open_page):
    with open_page(made(), drawn=False) as page:
        page.page.locator("#speed").select_option("10")
        page.page.get_by_role("button", name="Play").click()
        page.page.get_by_role("button", name="Play").wait_for()
        assert page.run("() => irlx.frame") == FRAMES - 1
        page.page.get_by_role("button", name="Loop").click()
        page.page.get_by_role("button", name="Play").click()
        page.page.wait_for_timeout(300)
        assert page.page.get_by_role("button", name="Pause").is_visible()


def test_light_and_dark(made, open_page):
    means = {}
    for scheme in ("light", "dark"):
        with open_page(made(), scheme=scheme, drawn=False) as page:
            assert page.run("() => document.documentElement.dataset.theme") == scheme
            means[scheme] = np.array(page.colours("body")["mean"])
    assert (means["light"] - means["dark"]).min() > DARKER


@pytest.mark.parametrize(
    ("width", "height"),
    [
        (390, 844),
        (844, 390),
        *(pytest.param(*size, marks=pytest.mark.slow) for size in ((320, 568), (820, 1180), (2560, 1440))),
    ],
)
def test_nothing_overflows(made, open_page, width, height):
    with open_page(made(), width=width, height=height, drawn=False) as page:
        for name in page.page.locator("[role=tab]").all_inner_texts():
            page.page.get_by_role("tab", name=name).click()
            size = page.run(
                "() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
            )
            assert size[0] <= width, name
            assert size[1] <= height, name
        for part in ("#scene", "#slider", "#play", "#speed", "#theme"):
            box = page.page.locator(part).bounding_box()
            assert box["x"] >= 0, part
            assert box["x"] + box["width"] <= width + 0.5, part
            assert box["y"] + box["height"] <= height + 0.5, part


def test_an_incomplete_run_says_so(made, open_page):
    with open_page(
        made(complete=False, diagnostics=["made.irl:6: error IRL520: joint 'stretch' ends"]), drawn=False
    ) as page:
        banner = page.page.get_by_role("alert").inner_text()
        assert "not complete" in banner
        assert "IRL520" in banner
        assert page.page.locator("#state").inner_text() == "incomplete"
        page.page.locator("#banner summary").click()
        assert page.page.get_by_role("alert").inner_text().count("IRL520") == 1


def test_without_webgl_the_rest_works(made, open_page):
    none = """
        const other = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind.startsWith('webgl') ? null : other.call(this, kind, ...rest);
        };
        console.error = () => {};
    """
    with open_page(made(), before=none) as page:
        assert "WebGL" in page.page.locator(".no-scene").inner_text()
        page.seek(30)
        assert page.page.locator("#program .lit").get_attribute("data-line") == "5"


@pytest.mark.req("REP-04")
def test_where_motion_is_welcome_it_plays_by_itself_and_asks_for_itself_alone(made, open_page):
    path = made()
    with open_page(path, where="", drawn=False) as page:
        page.page.wait_for_timeout(200)
        assert page.run("() => irlx.frame") == 0
    with open_page(path, still=False, where="", drawn=False) as page:
        page.page.wait_for_timeout(300)
        page.page.wait_for_function("() => irlx.frame > 3")
        asked = [url for url in page.requests if not url.startswith("data:")]
    assert asked == [path.as_uri()]


def test_the_time_of_the_address_goes_with_it(made, open_page):
    path = made()
    with open_page(path, where="#t=0.5", drawn=False) as page:
        assert page.run("() => irlx.frame") == 50
        assert page.page.url == path.as_uri() + "#t=0.5"
        page.page.keyboard.press("ArrowRight")
        assert page.page.url == path.as_uri()
        assert page.run("() => irlx.frame") == 51


def test_data_of_another_version_is_refused_in_words(made, tab):
    with tab() as page:
        page.goto(made(format="irlx page 9").as_uri())
        assert "'irlx page 9'" in page.get_by_role("alert").inner_text()


@pytest.fixture(scope="module")
def shown(made, open_page):
    """The page made by hand, opened once for tests that leave it as it is but for the frame.

    They come last, so that the others find its tab.
    """
    with open_page(made(), drawn=False) as page:
        yield page


@pytest.mark.req("REP-04")
def test_the_slider_moves_the_tool(shown):
    truth = tool_poses()
    for frame in (0, 1, 49, 50, 73, FRAMES - 1):
        shown.seek(frame)
        assert shown.run("() => irlx.frame") == frame
        pose = np.array(shown.run("() => irlx.toolPose()"))
        assert np.abs(pose[:3] - truth[frame, :3]).max() < 1e-12
        assert min(np.abs(pose[3:] - sign * truth[frame, 3:]).max() for sign in (1, -1)) < 1e-12


def test_paused_it_draws_nothing(shown):
    shown.run(
        """() => {
            window.drawn = 0;
            const ask = window.requestAnimationFrame;
            window.requestAnimationFrame = call => ask(time => { window.drawn += 1; call(time); });
        }"""
    )
    shown.page.wait_for_timeout(300)
    assert shown.run("() => window.drawn") <= 2


@pytest.mark.req("REP-04")
def test_the_line_in_execution_is_lit(shown):
    for frame, line in ((0, None), (10, "5"), (51, "6")):
        shown.seek(frame)
        lit = shown.page.locator("#program .lit")
        assert lit.count() == (line is not None)
        if line is not None:
            assert lit.get_attribute("data-line") == line
    shown.page.locator("#program li[data-line='5'] code").click()
    assert shown.run("() => irlx.frame") == 1
    assert "<b>a comment</b>" in shown.page.locator("#program").inner_text()
    assert "alert(1)" in shown.page.locator("#program .string").inner_text()


def test_events_and_joints(shown):
    shown.page.get_by_role("tab", name="Events 4").click()
    assert shown.page.locator(".events li").count() == 4
    shown.page.locator(".events li", has_text="upper position").get_by_role("button").click()
    assert shown.run("() => irlx.frame") == 60
    assert "</script><b>written</b>" in shown.page.locator(".events").inner_text()
    assert "null" not in shown.page.locator("#events").inner_text()
    held = shown.page.locator("#joints .held")
    assert held.count() == 1
    assert held.inner_text().split() == ["stretch", "300.0", "mm"]
    assert "stretch at its upper position limit" in shown.page.locator("#status").inner_text()
    shown.seek(59)
    assert shown.page.locator("#joints .held").count() == 0
    shown.page.get_by_role("tab", name="Program").click()


def test_curves_seek(shown):
    over = shown.page.locator("[data-plot=position] .u-over")
    box = over.bounding_box()
    shown.page.mouse.click(box["x"] + box["width"] / 4, box["y"] + box["height"] / 2)
    assert abs(shown.run("() => irlx.frame") - 25) <= 1
    shown.page.mouse.down()
    shown.page.mouse.move(box["x"] + box["width"] * 0.7, box["y"] + box["height"] / 2)
    shown.page.mouse.up()
    assert abs(shown.run("() => irlx.frame") - 70) <= 1
    shown.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    shown.page.keyboard.down("Control")
    shown.page.mouse.wheel(0, -300)
    shown.page.keyboard.up("Control")
    shown.page.mouse.click(box["x"] + 1, box["y"] + box["height"] / 2)
    assert shown.run("() => irlx.frame") == pytest.approx(50 - 50 / np.e, abs=2)
    shown.page.mouse.dblclick(box["x"] + 1, box["y"] + box["height"] / 2)
    shown.page.mouse.click(box["x"] + 1, box["y"] + box["height"] / 2)
    assert shown.run("() => irlx.frame") == 0
    plots = shown.page.locator(".plot").evaluate_all("all => all.map(plot => plot.dataset.plot)")
    assert plots == ["position", "speed", "path", "clearance", "singular"]
