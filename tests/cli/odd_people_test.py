"""People whose files leave something out or get it wrong: levels all the same, with a warning, or one clear error."""
import base64
import json
import pathlib
import unittest

from odd_person import OddPerson
from support import ProgramTest, run

BASIS = pathlib.Path(__file__).parent.parent / "data" / "basis"


class OddPeople(ProgramTest):
    def made(self, person, *words):
        """The facts of the levels made of the person; the words stand in a warning."""
        facts = self.folder / "facts.json"
        result = self.bake(person, "--json", facts)
        self.assert_succeeds(result)
        warnings = [line for line in result.stderr.lower().splitlines() if "warning:" in line]
        if words:
            self.assertTrue(any(all(word in line for word in words) for line in warnings), result.stderr)
        self.assert_valid(self.folder / "out.glb")
        return json.loads(facts.read_text())

    def bake(self, person, *options):
        return run("flaneur", "avatar", person.write(self.folder / "odd.gltf"), "-o", self.folder / "out.glb", *options)

    def triangles(self, facts):
        return [level["triangles"] for level in facts["levels"]]

    def test_a_plain_person_is_no_news(self):
        facts = self.made(OddPerson())
        self.assertEqual(self.triangles(facts)[0], 704)
        self.assertEqual(facts["joints"], 3)

    def test_a_name_without_an_ending_is_a_folder(self):
        person = OddPerson().write(self.folder / "odd.gltf")
        self.assert_succeeds(run("flaneur", "avatar", person, "-o", self.folder / "people"))
        self.assertEqual({file.name for file in (self.folder / "people").iterdir()}, {"odd.glb", "odd.png", "index.html"})
        self.assert_fails(run("flaneur", "avatar", person, "-o", self.folder / "others", "--sheet", self.folder / "s.png"), "--sheet", "FILE.glb")
        self.assertFalse((self.folder / "others").exists())

    def test_without_uvs(self):
        person = OddPerson()
        person.uvs, person.image = [], "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
        self.made(person, "picture", "uvs")

    def test_without_normals(self):
        person = OddPerson()
        person.normals = []
        self.made(person)

    def test_degenerate_triangles_go(self):
        person = OddPerson()
        person.indices += [0, 0, 1, 5, 5, 5, 2, 3, 2] * 20
        facts = self.made(person)
        self.assertLess(facts["levels"][-1]["posed_error_mm"], 60)

    def test_leaves_on_one_edge_stay(self):
        person = OddPerson()
        for k in range(5):  # five faces on the edge between two vertices
            person.positions.append((0.5, 1.0 + 0.1 * k, 0.3))
            person.normals.append((0.0, 0.0, 1.0))
            person.uvs.append((0.0, 0.0))
            person.joints.append((0, 0, 0, 0))
            person.weights.append((1.0, 0.0, 0.0, 0.0))
            person.indices += [176, 177, len(person.positions) - 1]
        self.assertEqual(self.triangles(self.made(person))[0], 709)

    def test_weights_that_do_not_sum_to_one(self):
        person = OddPerson()
        person.weights = [(3.0, 0.0, 0.0, 0.0)] * len(person.weights)
        self.made(person, "weights", "sum to 1")

    def test_vertices_without_weight(self):
        person = OddPerson()
        person.weights[:10] = [(0.0, 0.0, 0.0, 0.0)] * 10
        self.made(person, "no weight")

    def test_more_than_four_weights(self):
        person = OddPerson()
        person.weights = [(0.4, 0.3, 0.0, 0.0)] * len(person.weights)
        person.more_influences = True
        self.made(person)

    def test_bones_without_weights_go(self):
        person = OddPerson()
        person.bones = 60
        self.assertEqual(self.made(person)["joints"], 3)

    def test_no_bones(self):
        person = OddPerson()
        person.bones, person.joints = 0, []
        self.assert_fails(self.bake(person), "odd.gltf")

    def test_five_hundred_bones(self):
        person = OddPerson(rings=40)
        person.bones = 500
        self.assertEqual(self.made(person)["joints"], 3)
        person.joints = [(k % 500, 0, 0, 0) for k in range(len(person.joints))]
        self.assertLessEqual(self.made(person, "joints", "reduced")["joints"], 256)

    def test_a_skin_without_bind_matrices(self):
        person = OddPerson()
        person.binds = False
        self.made(person, "inverse bind matrices", "export")

    def test_mirrored_scale(self):
        person = OddPerson()
        person.scale = [-1, 1, 1]
        facts = self.made(person)
        self.assertAlmostEqual(facts["height_m"], 1.75, places=3)

    def test_a_picture_that_is_not_there(self):
        person = OddPerson()
        person.image = "nowhere.png"
        self.assert_fails(self.bake(person), "nowhere.png")

    def test_a_picture_in_basis_universal(self):
        for name in ("etc1s", "uastc_zstd_alpha"):
            person, ktx2 = OddPerson(), (BASIS / f"{name}.ktx2").read_bytes()
            person.image = "data:image/ktx2;base64," + base64.b64encode(ktx2).decode()
            self.made(person)
            with self.subTest("cut short"):
                person.image = "data:image/ktx2;base64," + base64.b64encode(ktx2[: len(ktx2) // 2]).decode()
                self.assert_fails(self.bake(person), "image 0", "cut short")

    def test_eyes_that_close_by_morph_targets(self):
        person = OddPerson()
        lids = [(0, -0.02, 0) if y > 1.6 and z > 0 else (0, 0, 0) for _, y, z in person.positions]
        person.targets = {"smile": lids, "eyeBlinkLeft": lids}
        facts = self.made(person, "morph targets", "close eyes")
        self.assertEqual(facts["joints"], 3 + 1)
        self.assertEqual([clip["name"] for clip in facts["clips"]], ["walk", "idle", "talk"])
        person.targets = {"eyeBlinkLeft": lids[:-1]}
        self.assert_fails(self.bake(person), "morph target 0")
        person.targets = {"eyeBlinkLeft": [(float("inf"), 0, 0)] * len(lids)}
        self.assert_fails(self.bake(person), "morph target 0", "repair")

    def test_a_walk_of_ten_minutes_is_cut(self):
        person = OddPerson()
        person.cycles = 600
        (walk,) = self.made(person, "'walk' is long")["clips"]
        self.assertLessEqual(walk["duration_s"], 12.1)

    def test_a_walk_of_one_frame_is_none(self):
        person = OddPerson()
        person.keys = 1
        self.assert_fails(self.bake(person), "no walk clip", "'walk' moves nothing")

    def test_two_triangles(self):
        person = OddPerson(rings=2, sides=4)
        person.indices = [0, 4, 1, 1, 4, 5]
        self.assertEqual(self.triangles(self.made(person)), [2])

    def test_very_many_triangles(self):
        facts = self.made(OddPerson(rings=800, sides=100))
        self.assertEqual(self.triangles(facts)[0], 319600)
        self.assertLess(self.triangles(facts)[-1], 1000)
        self.assertLess(facts["levels"][1]["posed_error_mm"], 2)


if __name__ == "__main__":
    unittest.main()
