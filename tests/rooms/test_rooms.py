"""The house holds: which room may know which, one way, and no circle among rooms or among files.

A room is a folder of sources. One knows another if a file includes a header of it, or uses a function or table that is
defined there. ROOMS is the whole list: a new pair is a decision and fails until it stands here, and so does a pair that
is no longer needed. The room of a method is not on the list: it may know METHOD, and no other room knows it.
"""
import os
import re
import sys
import unittest

SOURCE = sys.argv.pop(1)
FLOORS = ["common", "generators", "eval"]  # a floor knows those before it alone
# What users of the library call first; it knows the methods' interface: a room of its own.
LIBRARY = ("generators/mskit.h", "generators/ms_generate.h", "generators/ms_generate.c")
MADE = "base/ms_version.h"  # by the build, in another folder
# Installed apart from the public ones (mskit/dev), where a bare name of a public one is not found.
DEV = ("mesh/ms_closest.h", "voxel/ms_distance.h", "voxel/ms_raster.h", "voxel/ms_tally.h")

ROOMS = {
    "common/base": [],
    "common/clump": ["common/base", "common/mesh", "common/voxel"],
    "common/clump/formats": ["common/base", "common/clump", "common/mesh"],
    "common/contact": ["common/base", "common/clump", "common/mesh", "common/shape", "common/voxel"],
    "common/expect": ["common/base", "common/mesh", "common/voxel"],
    "common/measure": ["common/base", "common/clump", "common/mesh", "common/voxel"],
    "common/mesh": ["common/base"],
    "common/mesh/formats": ["common/base", "common/mesh"],
    "common/shape": ["common/base", "common/mesh"],
    "common/volume": ["common/base"],
    "common/voxel": ["common/base", "common/mesh", "common/volume"],
    "generators": ["common/base", "common/clump", "common/clump/formats", "common/measure", "common/voxel"],
    "generators/library": ["common/base", "common/clump", "common/clump/formats", "common/contact", "common/expect",
                           "common/measure", "common/mesh", "common/mesh/formats", "common/shape", "common/volume",
                           "common/voxel", "generators"],
    "generators/shared": ["common/base", "common/clump", "common/measure", "common/voxel", "generators"],
    "eval": ["common/base", "eval/cli", "eval/command"],
    "eval/chart": ["common/base", "common/clump", "common/mesh", "common/voxel"],
    "eval/cli": ["common/base", "common/clump", "common/clump/formats", "common/expect", "common/measure",
                 "common/mesh", "common/mesh/formats", "common/volume", "common/voxel", "generators", "eval/view"],
    "eval/command": ["common/base", "common/clump", "common/clump/formats", "common/contact", "common/measure",
                     "common/mesh", "common/mesh/formats", "common/shape", "common/voxel", "generators",
                     "eval/chart", "eval/cli", "eval/compare", "eval/contact", "eval/grains", "eval/population",
                     "eval/scene", "eval/stability", "eval/view"],
    "eval/compare": ["common/base", "common/clump", "common/clump/formats", "common/expect", "common/measure",
                     "common/mesh",
                     "common/volume", "common/voxel", "generators", "eval/chart", "eval/cli", "eval/queue",
                     "eval/view"],
    "eval/contact": ["common/base", "common/contact", "eval/chart", "eval/cli"],
    "eval/grains": ["common/base", "common/clump", "common/clump/formats", "common/measure",
                    "common/volume", "generators", "eval/chart", "eval/cli", "eval/queue", "eval/view"],
    "eval/population": ["common/base", "common/clump", "common/clump/formats", "eval/chart", "eval/cli", "eval/grains"],
    "eval/queue": ["common/base", "eval/cli"],
    "eval/scene": ["common/base", "common/clump", "common/clump/formats", "common/expect", "common/measure",
                   "common/mesh", "generators", "eval/chart", "eval/cli", "eval/queue", "eval/view"],
    "eval/stability": ["common/base", "common/clump", "common/measure", "common/mesh", "common/shape", "common/voxel",
                       "generators", "eval/chart", "eval/cli", "eval/queue", "eval/view"],
    "eval/view": ["common/base", "common/clump", "common/clump/formats", "common/measure", "common/mesh",
                  "common/mesh/formats", "common/voxel", "eval/chart"],
}
METHOD = ["common/base", "common/clump", "common/measure", "common/mesh", "common/voxel", "generators",
          "generators/shared"]


def room_of(path):
    return "generators/library" if path in LIBRARY else os.path.dirname(path)


def floor_of(room):
    return room.split("/")[0]


def is_method(room):
    return room.startswith("generators/") and room not in ("generators/shared", "generators/library")


def read_sources():
    sources = {}
    for floor in FLOORS:
        for folder, _, names in os.walk(os.path.join(SOURCE, floor)):
            for name in names:
                if name.endswith((".c", ".h", ".h.in")):
                    path = os.path.join(folder, name)
                    with open(path, encoding="utf-8") as stream:
                        sources[os.path.relpath(path, SOURCE).removesuffix(".in")] = stream.read()
    return sources


def strip(text):
    """Without comments and texts."""
    return re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', " ", text, flags=re.S)


def find_definitions(codes):
    """The file that defines each name that leaves a file. Definitions begin a line, as .clang-format has it."""
    functions = re.compile(r"^(?!static|typedef)[a-z][\w *]*?\b(ms_\w+)\([^;{}]*\)\s*\{", re.M)
    tables = re.compile(r"^const [\w *]*?\b(ms_\w+)(?:\[\w*\])? = ", re.M)
    return {name: path for path, code in codes.items() if path.endswith(".c")
            for pattern in (functions, tables) for name in pattern.findall(code)}


def find_circle(graph):
    """Some circle of a graph {node: nodes} as a list, or None."""
    done, way = set(), []

    def visit(node):
        if node in way:
            return way[way.index(node):] + [node]
        if node in done:
            return None
        way.append(node)
        for following in sorted(graph.get(node, ())):
            circle = visit(following)
            if circle:
                return circle
        done.add(way.pop())
        return None

    for start in sorted(graph):
        circle = visit(start)
        if circle:
            return circle
    return None


class Rooms(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.sources = read_sources()
        cls.codes = {path: strip(text) for path, text in cls.sources.items()}
        cls.headers = {os.path.basename(path): path for path in cls.sources if path.endswith(".h")}
        cls.includes = [(path, name, cls.headers[os.path.basename(name)]) for path, text in cls.sources.items()
                        for name in re.findall(r'^#include "([^"]+)"', text, re.M)]
        where = find_definitions(cls.codes)
        cls.uses = {path: {where[name] for name in re.findall(r"\bms_\w+\b", code) if name in where} - {path}
                    for path, code in cls.codes.items() if path.endswith(".c")}
        cls.known = {}
        for path, other in [(path, header) for path, _, header in cls.includes] + \
                           [(path, other) for path in cls.uses for other in cls.uses[path]]:
            if room_of(path) != room_of(other):
                cls.known.setdefault((room_of(path), room_of(other)), f"{path} needs {other}")

    def test_sources_are_found(self):
        self.assertGreater(len(self.sources), 150)
        self.assertGreater(len(find_definitions(self.codes)), 300)
        rooms = {room_of(path) for path in self.sources}
        self.assertEqual(set(ROOMS), {room for room in rooms if not is_method(room)})
        self.assertGreater(len(rooms), len(ROOMS) + 3)

    def test_pairs_are_on_the_list(self):
        listed = {(room, other) for room, others in ROOMS.items() for other in others}
        new = [why for (room, other), why in sorted(self.known.items())
               if (other not in METHOD if is_method(room) else (room, other) not in listed)]
        self.assertEqual(new, [], "these rooms do not know each other; a new pair is a decision (ROOMS)")
        self.assertEqual(sorted(listed - set(self.known)), [], "these pairs are no longer needed; strike them (ROOMS)")

    def test_nothing_knows_a_higher_floor(self):
        for (room, other), why in self.known.items():
            self.assertGreaterEqual(FLOORS.index(floor_of(room)), FLOORS.index(floor_of(other)), why)

    def test_methods_are_known_by_the_list_alone(self):
        for (_, other), why in self.known.items():
            self.assertFalse(is_method(other), why)

    def test_rooms_form_no_circle(self):
        graph = {}
        for room, other in self.known:
            graph.setdefault(room, set()).add(other)
        self.assertIsNone(find_circle(graph))

    def test_files_form_no_circle(self):
        self.assertIsNone(find_circle(self.uses))
        headers = {}
        for path, _, header in self.includes:
            if path.endswith(".h"):
                headers.setdefault(path, set()).add(header)
        self.assertIsNone(find_circle(headers))

    def test_own_room_by_bare_name_others_by_room(self):
        for path, name, header in self.includes:
            full = header.split("/", 1)[1]
            place = path.split("/", 1)[1]
            apart = place in DEV and full not in DEV or MADE in (place, full)
            own = os.path.dirname(path) == os.path.dirname(header) and not apart
            self.assertEqual(name, os.path.basename(header) if own else full, path)

    def test_names_of_headers_are_unique(self):
        self.assertEqual(len(self.headers), sum(path.endswith(".h") for path in self.sources))

    def test_functions_are_defined_in_the_room_of_their_header(self):
        where = find_definitions(self.codes)
        for path, code in self.codes.items():
            if path.endswith(".h"):
                for name in re.findall(r"^[a-z][\w *]*?\b(ms_\w+)\([^{}]*?\)[^;{}()]*;", code, re.M):
                    if name in where:
                        self.assertEqual(room_of(path), room_of(where[name]), name)

    def test_names_stand_for_one_thing(self):
        types, functions = {}, {}
        for path, code in self.codes.items():
            for name in re.findall(r"^typedef (?:struct|enum|union) \w*\s*\{[^}]*\} (\w+);", code, re.M):
                types.setdefault(name, []).append(path)
            if floor_of(path) != "eval":
                for name in re.findall(r"^static (?!const)[\w *]*?\b(\w+)\([^;{}]*\)\s*\{", code, re.M):
                    functions.setdefault(name, []).append(path)
        for names in (types, functions):
            self.assertGreater(len(names), 50)
            self.assertEqual({name: paths for name, paths in names.items() if len(paths) > 1}, {})

    def test_sentences_of_the_library_name_no_flag(self):
        """They stand in exceptions of Python, too: options are named as they are there, `label`."""
        found = {path: flags for path, text in self.sources.items() if floor_of(path) != "eval"
                 for flags in [re.findall(r'"(?:\\.|[^"\\\n])*--[a-z](?:\\.|[^"\\\n])*"',
                                          re.sub(r"/\*.*?\*/", " ", text, flags=re.S))] if flags}
        self.assertEqual(found, {})


if __name__ == "__main__":
    unittest.main()
