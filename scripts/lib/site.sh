# A Python environment with what builds the pages of docs/ as a site. Source this file; it needs build.sh.

site_packages=(mkdocs==1.6.1 mkdocs-material==9.8.2 pymdown-extensions==12.3 latex2mathml==3.81.1)

# provide_site: prints the prefix of the environment; makes it first if it is not there. Fails, with a warning, where pip gets no packages.
provide_site() {
  local prefix
  prefix=$(cache_prefix site "$(/usr/bin/python3 --version)" "${site_packages[@]}")
  if ! is_built "$prefix"; then
    say "making a Python environment for the pages: $prefix"
    rm -rf "$prefix"
    if ! {
      /usr/bin/python3 -m venv "$prefix" && "$prefix/bin/pip" install -q --disable-pip-version-check "${site_packages[@]}"
    } >"$work/site.log" 2>&1; then
      say "warning: the pages will not be built as a site: $(grep -m1 -i error "$work/site.log" || tail -n 1 "$work/site.log")"
      return 1
    fi
    touch "$prefix/.complete"
  fi
  echo "$prefix"
}
