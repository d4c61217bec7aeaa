"""The page of `flaneur check --html` in a browser: it zooms, marks and list light up together, and both can be used."""
import html
import json
import re
import shutil
import subprocess
import unittest

from support import ProgramTest, run

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

# Uses the page as a visitor does and leaves what was seen in its text, for the test to judge.
VISIT = """
const seen = {errors: []};
window.onerror = message => { seen.errors.push(String(message)); };
const send = (target, kind, options) =>
  target.dispatchEvent(new (kind == 'wheel' ? WheelEvent : kind.startsWith('pointer') ? PointerEvent : MouseEvent)(kind, {bubbles: true, cancelable: true, ...options}));
const box = () => { const b = document.getElementById('map').viewBox.baseVal; return [b.x, b.y, b.width, b.height]; };
const middle = node => { const r = node.getBoundingClientRect(); return [(r.left + r.right) / 2, (r.top + r.bottom) / 2]; };
const page = document.getElementById('map'), all = [...document.querySelectorAll('.item')], dots = [...marks.children];
const under = (x, y) => { const p = new DOMPoint(x, y).matrixTransform(page.getScreenCTM().inverse()); return [p.x, p.y]; };
seen.items = all.map(item => item.textContent);
seen.marks = dots.length;
seen.whole = box();
const [x, y] = middle(page);
const place = {clientX: x + 100, clientY: y + 60};
seen.underBefore = under(place.clientX, place.clientY);
send(page, 'wheel', {...place, deltaY: -400});
seen.zoomed = box();
seen.underAfter = under(place.clientX, place.clientY);
send(page, 'pointerdown', place);
send(window, 'pointermove', {clientX: x + 130, clientY: y + 60});
send(window, 'pointerup', {});
seen.dragged = box();
send(page, 'dblclick', place);
seen.back = box();
const dot = nodes[0];
send(dot, 'mouseenter', {bubbles: false});
seen.hoverMark = document.getElementById('hover').textContent;
seen.lit = [dot.classList.contains('on'), items[0].classList.contains('on'), items[1].classList.contains('on')];
send(dot, 'mouseleave', {bubbles: false});
seen.dark = items[0].classList.contains('on');
send(items[1], 'mouseenter', {bubbles: false});
seen.hoverItem = document.getElementById('hover').textContent;
seen.litByList = nodes[1].classList.contains('on');
items[1].click();
seen.near = box();
const [dotX, dotY] = middle(nodes[1].querySelector('circle'));
seen.fromMiddle = Math.hypot(dotX - x, dotY - y);
seen.dotSize = nodes[1].querySelector('circle').getBoundingClientRect().width;
const obstacle = [...page.querySelectorAll('path, circle')].find(node => node.querySelector('title'));
send(obstacle, 'mouseover', {});
seen.hoverObstacle = document.getElementById('hover').textContent;
const tick = document.querySelector('input[type=checkbox]');
tick.click();
seen.hidden = dots.filter(mark => mark.style.display == 'none').length;
seen.hiddenItems = all.filter(item => item.parentNode.hidden).length;
document.body.textContent = 'SEEN' + JSON.stringify(seen) + 'NEES';
"""


@unittest.skipIf(CHROMIUM is None, "no Chromium to look at the page with")
class MapPage(ProgramTest):
    def visit(self):
        """Two houses that overlap, a narrow gap beside a third, in a page that has been used."""
        def house(name, x):
            ring = [[x, 0], [x + 8, 0], [x + 8, 6], [x, 6], [x, 0]]
            return {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        obstacles = self.folder / "obstacles.geojson"
        obstacles.write_text(json.dumps({"type": "FeatureCollection", "flaneur": {"units": "m"},
                                         "features": [house("mill <b>", 0), house("barn & stable", 7), house("inn", 15.4)]}))
        page = self.folder / "page.html"
        run("flaneur", "check", obstacles, "--html", page)
        text = page.read_text()
        page.write_text(text.replace("</script></body>", VISIT + "</script></body>"))
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,800", f"--user-data-dir={self.folder / 'profile'}",
                   "--dump-dom", page.as_uri()]
        result = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
        found = re.search("SEEN(.*)NEES", result.stdout, re.DOTALL)
        self.assertTrue(found, result.stdout[-2000:] + result.stderr[-2000:])
        return json.loads(html.unescape(found.group(1)))

    def test_it_zooms_and_tells_which_finding(self):
        seen = self.visit()
        self.assertEqual(seen["errors"], [])
        self.assertEqual((len(seen["items"]), seen["marks"]), (2, 2))
        self.assertIn("mill <b>", seen["items"][0])
        self.assertLess(seen["zoomed"][2], 0.5 * seen["whole"][2], "the wheel zooms in,")
        for before, after in zip(seen["underBefore"], seen["underAfter"]):
            self.assertAlmostEqual(before, after, delta=2, msg="about the place under the mouse")
        self.assertEqual(seen["zoomed"][2:], seen["dragged"][2:])
        self.assertLess(seen["dragged"][0], seen["zoomed"][0], "dragging to the right shows what is on the left")
        self.assertEqual(seen["back"], seen["whole"], "a double click shows all")
        self.assertEqual((seen["lit"], seen["dark"]), ([True, True, False], False), "a mark lights up its line in the list")
        self.assertTrue(seen["hoverMark"].startswith("401 obstacles overlap"), seen["hoverMark"])
        self.assertTrue(seen["litByList"], "and a line its mark")
        self.assertTrue(seen["hoverItem"].startswith("403"), seen["hoverItem"])
        self.assertLess(seen["near"][2], seen["whole"][2] + 1)
        self.assertLess(seen["fromMiddle"], 2, "a click on a line brings its place to the middle")
        self.assertTrue(8 < seen["dotSize"] < 40, "marks keep their size")
        self.assertTrue(any(name in seen["hoverObstacle"] for name in ("mill", "barn", "inn")), seen["hoverObstacle"])
        self.assertEqual((seen["hidden"], seen["hiddenItems"]), (1, 1), "a kind of finding can be left out")


if __name__ == "__main__":
    unittest.main()
