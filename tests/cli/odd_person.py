"""A made-up person as a plain glTF, with whatever the test wants to be wrong with it."""
import array
import base64
import json
import math

FLOAT, SHORT, INT = 5126, 5123, 5125
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class OddPerson:
    """Two tubes of 1.75 m on two legs that swing about the hips; change the lists, then write."""

    def __init__(self, rings=12, sides=16):
        self.positions, self.normals, self.uvs, self.joints, self.weights, self.indices = [], [], [], [], [], []
        self.bones = 3  # root, left leg, right leg; more hang on the root and move nothing
        self.scale = None  # of the node above all
        self.more_influences = False  # a second set of joints and weights
        self.binds = True  # inverse bind matrices
        self.image = None  # uri of the picture
        self.cycles, self.keys = 1, 21  # of the walk: a second each, with so many keys
        self.targets = {}  # morph targets: offsets by name
        for x, bone in ((0.1, 1), (-0.1, 2)):
            self.add_tube(x, bone, rings, sides)

    def add_tube(self, x, bone, rings, sides):
        base = len(self.positions)
        for ring in range(rings):
            for side in range(sides):
                angle = 2 * math.pi * side / sides
                out = (math.cos(angle), 0.0, math.sin(angle))
                self.positions.append((x + 0.08 * out[0], 1.75 * ring / (rings - 1), 0.08 * out[2]))
                self.normals.append(out)
                self.uvs.append((side / sides, ring / (rings - 1)))
                self.joints.append((0 if ring > rings / 2 else bone, 0, 0, 0))
                self.weights.append((1.0, 0.0, 0.0, 0.0))
        for ring in range(rings - 1):
            for side in range(sides):
                a, b = base + ring * sides + side, base + ring * sides + (side + 1) % sides
                self.indices += [a, a + sides, b, b, a + sides, b + sides]

    def write(self, path):
        self.gltf = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "scene": 0}
        self.bytes = bytearray()
        attributes = {"POSITION": self.add("VEC3", self.positions, bounds=True)}
        if self.normals:
            attributes["NORMAL"] = self.add("VEC3", self.normals)
        if self.uvs:
            attributes["TEXCOORD_0"] = self.add("VEC2", self.uvs)
        if self.joints:
            attributes["JOINTS_0"] = self.add("VEC4", self.joints, SHORT)
            attributes["WEIGHTS_0"] = self.add("VEC4", self.weights)
        if self.more_influences:
            attributes["JOINTS_1"] = self.add("VEC4", [(2, 1, 0, 0)] * len(self.positions), SHORT)
            attributes["WEIGHTS_1"] = self.add("VEC4", [(0.2, 0.1, 0, 0)] * len(self.positions))
        primitive = {"attributes": attributes, "indices": self.add("SCALAR", [(i,) for i in self.indices], INT)}
        if self.image:
            primitive["material"] = 0
            self.gltf["images"] = [{"uri": self.image}]
            self.gltf["textures"] = [{"source": 0}]
            if self.image.startswith("data:image/ktx2"):
                self.gltf["textures"] = [{"extensions": {"KHR_texture_basisu": {"source": 0}}}]
                self.gltf["extensionsUsed"] = self.gltf["extensionsRequired"] = ["KHR_texture_basisu"]
            self.gltf["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        mesh = {"name": "body", "primitives": [primitive]}
        if self.targets:
            primitive["targets"] = [{"POSITION": self.add("VEC3", offsets)} for offsets in self.targets.values()]
            mesh["extras"] = {"targetNames": list(self.targets)}
        self.gltf["meshes"] = [mesh]
        self.add_skeleton()
        uri = "data:application/octet-stream;base64," + base64.b64encode(bytes(self.bytes)).decode()
        self.gltf["buffers"] = [{"byteLength": len(self.bytes), "uri": uri}]
        path.write_text(json.dumps(self.gltf))
        return path

    def add_skeleton(self):
        places = [(0, 0.9, 0), (0.1, 0.9, 0), (-0.1, 0.9, 0)] + [(0, 1, 0)] * (self.bones - 3)
        root = {"name": "person", "children": [1, 2]}
        if self.scale:
            root["scale"] = self.scale
        nodes = [root, {"name": "skin", "mesh": 0, "skin": 0}]
        for k, place in enumerate(places[:self.bones]):
            node = {"name": f"bone{k}", "translation": [a - b for a, b in zip(place, places[0])] if k else list(place)}
            nodes.append(node)
        if self.bones > 1:
            nodes[2]["children"] = list(range(3, 2 + self.bones))
        self.gltf["nodes"], self.gltf["scenes"] = nodes, [{"nodes": [0]}]
        inverse = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1) for x, y, z in places[:self.bones]]
        self.gltf["skins"] = [{"joints": list(range(2, 2 + self.bones))}]
        if inverse and self.binds:
            self.gltf["skins"][0]["inverseBindMatrices"] = self.add("MAT4", inverse)
        keys = range((self.keys - 1) * self.cycles + 1)
        times = [(k / max(self.keys - 1, 1),) for k in keys]
        swings = [0.3 * math.sin(2 * math.pi * t) for t, in times]
        samplers, channels = [], []
        for bone, sign in ((1, 1), (2, -1)):
            turns = [(math.sin(sign * s / 2), 0, 0, math.cos(s / 2)) for s in swings]
            samplers.append({"input": self.add("SCALAR", times, bounds=True), "output": self.add("VEC4", turns)})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": 2 + bone, "path": "rotation"}})
        if self.bones > 2:
            self.gltf["animations"] = [{"name": "walk", "channels": channels, "samplers": samplers}]

    def add(self, kind, rows, component=FLOAT, bounds=False):
        flat = [value for row in rows for value in row]
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        data = array.array({FLOAT: "f", SHORT: "H", INT: "I"}[component], flat).tobytes()
        self.gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        accessor = {"bufferView": len(self.gltf["bufferViews"]) - 1, "componentType": component, "count": len(rows), "type": kind}
        if bounds:
            columns = [flat[k::COMPONENTS[kind]] for k in range(COMPONENTS[kind])]
            accessor |= {"min": [min(c) for c in columns], "max": [max(c) for c in columns]}
        self.gltf["accessors"].append(accessor)
        return len(self.gltf["accessors"]) - 1
