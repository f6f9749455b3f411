#!/usr/bin/env python3
"""Tests of packaging/: what the recipes say against what CMake asks for, and of the version wherever it is written."""
import json
import os
import re
import subprocess
import sys
import tempfile
import types
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SPACK = "packaging/spack/spack_repo/gridmorph/packages/gridmorph/package.py"
CONDA = "packaging/conda/recipe.yaml"

# What CMake calls a dependency -> what Spack and conda-forge call it. Tests and benchmarks are nothing that conda packages.
NAMES = {
    "Kokkos": ("kokkos", "kokkos"),
    "CGNS": ("cgns", "cgns"),
    "HDF5": ("hdf5", "hdf5"),
    "ZLIB": ("zlib-api", "zlib"),
    "CLI11": ("cli11", "cli11"),
    "toml11": ("toml11", "toml11"),
    "nlohmann_json": ("nlohmann-json", "nlohmann_json"),
    "muparser": ("muparser", "muparser"),
    "nanoflann": ("nanoflann", "nanoflann"),
    "fmt": ("fmt", "fmt"),
    "GTest": ("googletest", None),
    "benchmark": ("benchmark", None),
}


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def only(pattern, path):
    """The one thing that `pattern` finds in a file."""
    found = re.findall(pattern, text_of(path), flags=re.MULTILINE)
    if len(found) != 1:
        raise AssertionError("%s: %r is there %d times" % (path, pattern, len(found)))
    return found[0]


def packaging_files():
    return [os.path.relpath(os.path.join(folder, name), ROOT)
            for folder, _, names in os.walk(os.path.join(ROOT, "packaging")) for name in names if not name.endswith(".pyc")]


def cmake_options():
    """Options of gridmorph that a recipe can set."""
    return set(re.findall(r"^(?:cmake_dependent_)?option\(\s*(GRIDMORPH_\w+)", text_of("CMakeLists.txt"), flags=re.MULTILINE))


def required_packages():
    """Names of what CMake asks for, by the files that ask."""
    text = "".join(text_of(path) for path in ("cmake/gridmorphDependencies.cmake", "cmake/FindCGNS.cmake", "src/CMakeLists.txt"))
    found = re.findall(r'gridmorph_require\(GRIDMORPH_\w+ "[^"]*" (\w+)', text) + re.findall(r"find_package\((\w+)", text)
    return set(found) - {"MPI"}  # only where the CGNS that was found asks for it


class Installation(unittest.TestCase):
    """scripts/lib/apt.sh with another apt-get in front, which says what it is told to."""

    def run_apt(self, script, patience=30):
        with tempfile.TemporaryDirectory() as folder:
            fake = os.path.join(folder, "apt-get")
            with open(fake, "w", encoding="utf-8") as file:
                file.write("#!/bin/bash\n" + script)
            os.chmod(fake, 0o755)
            run = subprocess.run(
                ["bash", "-c", 'set -euo pipefail; cd "%s"; say() { echo "$*" >&2; }; fail() { say "$*"; exit 1; }; apt_log=log; '
                               '. "%s/scripts/lib/apt.sh"; apt_pause=0; apt_patience=%d; apt_run install thing' % (folder, ROOT, patience)],
                env=dict(os.environ, PATH=folder + ":" + os.environ["PATH"]), capture_output=True, text=True, timeout=60)
            log = os.path.join(folder, "log")
            text = ""
            if os.path.exists(log):
                with open(log, encoding="utf-8") as file:
                    text = file.read()
            return run, text

    def test_waits_while_another_has_the_package_database(self):
        run, log = self.run_apt('if [ ! -e again ]; then touch again; echo "E: Could not get lock /var/lib/dpkg/lock-frontend."; exit 100; fi\n'
                                'echo "Setting up thing"\n')
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("waiting for another installation", run.stderr)
        self.assertNotIn("Setting up", run.stderr + run.stdout)
        self.assertIn("Setting up thing", log)

    def test_does_not_wait_for_ever(self):
        run, _ = self.run_apt('echo "E: Could not get lock /var/lib/apt/lists/lock."; exit 100\n', patience=0)
        self.assertEqual(run.returncode, 1)
        self.assertIn("Could not get lock", run.stderr)

    def test_says_at_once_what_else_went_wrong_and_where_all_of_it_is(self):
        run, log = self.run_apt('echo "E: Unable to locate package thing"; exit 100\n')
        self.assertEqual(run.returncode, 1)
        self.assertIn("Unable to locate package thing", run.stderr)
        self.assertIn("is in log", run.stderr)
        self.assertIn("Unable to locate", log)


class Version(unittest.TestCase):
    def setUp(self):
        self.version = only(r"^  VERSION (\d+\.\d+\.\d+)$", "CMakeLists.txt")

    def test_is_the_newest_release_in_the_changelog(self):
        releases = re.findall(r"^## (\d+\.\d+\.\d+)", text_of("CHANGELOG.md"), flags=re.MULTILINE)
        self.assertEqual(releases[0], self.version)
        numbers = [tuple(map(int, release.split("."))) for release in releases]
        self.assertEqual(numbers, sorted(numbers, reverse=True))

    def test_is_the_one_of_citation_manual_and_recipes(self):
        self.assertEqual(only(r"^version: (\S+)$", "CITATION.cff"), self.version)
        self.assertEqual(only(r'^\.TH GRIDMORPH 1 "[^"]*" "gridmorph ([^"]*)"', "docs/gridmorph.1"), self.version)
        self.assertEqual(only(r'^  version: "([^"]*)"$', CONDA), self.version)
        self.assertEqual(only(r'^    version\("(\d[^"]*)"', SPACK), self.version)

    def test_has_one_date(self):
        date = re.search(r"^## " + re.escape(self.version) + r" \((\d{4}-\d\d-\d\d)\)$", text_of("CHANGELOG.md"), flags=re.MULTILINE)
        self.assertTrue(date, "CHANGELOG.md gives no date for " + self.version)
        self.assertEqual(only(r"^date-released: (\S+)$", "CITATION.cff"), date.group(1))
        self.assertEqual(only(r'^\.TH GRIDMORPH 1 "([^"]*)"', "docs/gridmorph.1"), date.group(1))

    def test_is_in_what_the_pages_tell_others_to_ask_for(self):
        self.assertEqual(only(r"find_package\(gridmorph (\S+) REQUIRED\)", "docs/building.md"), ".".join(self.version.split(".")[:2]))


class Recipes(unittest.TestCase):
    def test_set_options_that_there_are(self):
        known, asked = cmake_options(), {}
        self.assertGreater(len(known), 5)
        for path in packaging_files():
            for option in re.findall(r'(?:-D|define(?:_from_variant)?\(\s*")(GRIDMORPH_\w+)', text_of(path)):
                asked.setdefault(option, []).append(path)
        self.assertGreater(len(asked), 4)
        self.assertEqual({option: paths for option, paths in asked.items() if option not in known}, {})

    def test_name_every_dependency(self):
        names = required_packages()
        self.assertEqual(names - set(NAMES), set(), "a dependency that this test does not know")
        self.assertEqual(set(NAMES) - names, set(), "a dependency that nobody asks for any more")
        for spack, conda in NAMES.values():
            self.assertRegex(text_of(SPACK), r'depends_on\("%s["@+~]' % re.escape(spack))
            if conda:
                self.assertRegex(text_of(CONDA), r"(?m)^    - %s( .*)?$" % re.escape(conda))

    def test_ask_for_the_versions_that_cmake_asks_for(self):
        cmake = only(r"^cmake_minimum_required\(VERSION ([\d.]+)\)", "CMakeLists.txt")
        kokkos = only(r"^set\(GRIDMORPH_KOKKOS_MINIMUM ([\d.]+)\)", "cmake/gridmorphCheckKokkos.cmake")
        self.assertIn('depends_on("cmake@%s:"' % cmake, text_of(SPACK))
        self.assertIn('depends_on("kokkos@%s.00:' % kokkos, text_of(SPACK))
        self.assertIn("- cmake >=%s\n" % cmake, text_of(CONDA))
        self.assertIn("- kokkos >=%s\n" % kokkos, text_of(CONDA))

    def test_name_files_and_presets_that_there_are(self):
        presets = {preset["name"] for preset in json.loads(text_of("CMakePresets.json"))["configurePresets"]}
        for path in packaging_files():
            text = text_of(path)
            for preset in re.findall(r"--preset (\w+)", text):
                self.assertIn(preset, presets, path)
            for name in re.findall(r"(?<![\w/])((?:scripts|packaging)/[\w./-]+)", text):
                self.assertTrue(os.path.exists(os.path.join(ROOT, name)), path + ": " + name)

    def test_are_well_formed(self):
        for path in packaging_files():
            if path.endswith(".sh"):
                self.assertEqual(subprocess.run(["bash", "-n", os.path.join(ROOT, path)], check=False).returncode, 0, path)
        try:
            import yaml
        except ImportError:
            self.skipTest("PyYAML is not installed")
        recipe = yaml.safe_load(text_of(CONDA))
        self.assertEqual(recipe["package"]["name"], "gridmorph")
        self.assertTrue(os.path.samefile(os.path.join(ROOT, "packaging/conda", recipe["source"]["path"]), ROOT))
        for name in recipe["about"]["license_file"]:
            self.assertTrue(os.path.exists(os.path.join(ROOT, name)), name)


class FakeSpec:
    """A Spack spec of chosen variants; packages that it depends on lie in /prefix/NAME."""

    def __init__(self, variants):
        self.variants = variants

    def satisfies(self, text):
        return self.variants[text[1:]] if text[0] == "+" else not self.variants[text[1:]]

    def __getitem__(self, name):
        return types.SimpleNamespace(prefix="/prefix/" + name, hipcc="hipcc", kokkos_cxx="nvcc_wrapper")


def spack_recipe():
    """The recipe, run with the words of Spack that it uses; what it declares is noted in `declared`."""
    declared = {}

    def directive(name):
        return lambda *args, **options: declared.setdefault(name, []).append((args, options))

    class When:
        def __init__(self, *_):
            pass

        __enter__ = __exit__ = lambda self, *_: None

    class Package:
        cuda_arch_values, amdgpu_targets, run_tests = ("90",), ("gfx90a",), False

        def define(self, name, value):
            return (name, value)

        def define_from_variant(self, name, variant):
            return (name, self.spec.satisfies("+" + variant))

        def __getitem__(self, name):
            return self.spec[name]

    modules = {"spack": {}, "spack.package": {"when": When}, "spack_repo": {}, "spack_repo.builtin": {},
               "spack_repo.builtin.build_systems": {}}
    for name in ("conflicts", "depends_on", "extends", "license", "variant", "version"):
        modules["spack.package"][name] = directive(name)
    for module, name in (("cmake", "CMakePackage"), ("cuda", "CudaPackage"), ("python", "PythonExtension"), ("rocm", "ROCmPackage")):
        modules["spack_repo.builtin.build_systems." + module] = {name: type(name, (Package,) if module == "cmake" else (), dict(
            cuda_arch_values=("90",), amdgpu_targets=("gfx90a",)))}
    for name, contents in modules.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(contents)
    try:
        space = {"__file__": os.path.join(ROOT, SPACK), "__name__": "recipe"}
        exec(compile(text_of(SPACK), SPACK, "exec"), space)  # pylint: disable=exec-used
    finally:
        for name in modules:
            del sys.modules[name]
    return space, declared


class SpackRecipe(unittest.TestCase):
    def test_takes_the_sources_that_it_lies_in(self):
        space, _ = spack_recipe()
        self.assertTrue(os.path.samefile(space["CLONE"], ROOT))

    def test_gives_each_variant_its_option(self):
        space, declared = spack_recipe()
        variants = {args[0]: options["default"] for args, options in declared["variant"]}
        variants.update(cuda=False, rocm=False)
        recipe = space["Gridmorph"]()

        def arguments(**changes):
            recipe.spec = FakeSpec(dict(variants, **changes))
            return dict(recipe.cmake_args())

        for variant, option in (("io", "GRIDMORPH_ENABLE_IO"), ("cli", "GRIDMORPH_ENABLE_CLI"), ("python", "GRIDMORPH_ENABLE_PYTHON"),
                                ("examples", "GRIDMORPH_ENABLE_EXAMPLES"), ("benchmarks", "GRIDMORPH_ENABLE_BENCHMARKS"),
                                ("shared", "BUILD_SHARED_LIBS")):
            self.assertEqual([arguments(**{variant: value})[option] for value in (False, True)], [False, True], variant)
        self.assertEqual(arguments(cuda=True)["CMAKE_CXX_COMPILER"], "nvcc_wrapper")
        self.assertNotIn("CMAKE_CXX_COMPILER", arguments())
        self.assertNotIn("CGNS_ROOT", arguments(io=False, cli=False))
        self.assertEqual({name for name in arguments() if name.startswith("GRIDMORPH_")} - cmake_options(), set())


class Toml11(unittest.TestCase):
    """Debian 12 has version 3, newer ones have version 4: two files know the difference, and others go by them."""

    def test_only_these_files_use_what_the_versions_name_differently(self):
        folder = os.path.join(ROOT, "src", "gridmorph")
        found = set()
        for where, _, names in os.walk(folder):
            for name in names:
                with open(os.path.join(where, name), encoding="utf-8") as file:
                    if re.search(r"as_string\(\)|TOML11_VERSION|\.location\(\)", file.read()):
                        found.add(os.path.relpath(os.path.join(where, name), folder))
        self.assertEqual(found, {"case/detail/toml.hpp", "case/detail/parse_toml.cpp"})


if __name__ == "__main__":
    unittest.main()
