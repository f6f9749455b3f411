# Completion of gridmorph for bash; installed as share/bash-completion/completions/gridmorph, or: source gridmorph.bash
# zsh: autoload -U +X bashcompinit && bashcompinit, then the same.
#
# Commands and options are those that the program's own --help lists, so that this file has nothing to keep up with.

_gridmorph() {
  local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local commands command="" word n
  COMPREPLY=()
  commands=$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z][a-z]*\)  .*/\1/p')
  for ((n = 1; n < COMP_CWORD && ${#command} == 0; n++)); do
    for word in $commands; do
      [[ ${COMP_WORDS[n]} == "$word" ]] && command=$word
    done
  done
  if [[ $current == -* ]]; then
    local options
    # shellcheck disable=SC2086 # no command: one word less
    options=$("$program" $command --help 2>/dev/null | sed -n 's/^  \(-[^ {]*\).*/\1/p' | tr ',' '\n')
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    return
  fi
  case $previous in
    -q | --quiet | --json | --dry-run | --optimise | --all | --match | --no-periodic | --ascii | --version | -h | --help) previous="" ;; # nothing follows these
  esac
  case $previous in
    -t | --threads | --set | --limit | -n | --nodes | -e | --elements | -a | --angle | --gap | --split | --match-tolerance | -p | --patches | -b | --blade | -w | --wall | --radius | --blade-layers | --wall-layers | --run-out | --matching-tolerance | --open-faces | --plane | --span | --i | --j | --k | --wall | --box | --moved | --dpi) return ;;
    -m | --motion) mapfile -t COMPREPLY < <(compgen -W "rotation chord gap all" -- "$current") ;;
    --tip) mapfile -t COMPREPLY < <(compgen -W "none flat squealer groove" -- "$current") ;;
    --axis) mapfile -t COMPREPLY < <(compgen -W "x y z" -- "$current") ;;
    --color) mapfile -t COMPREPLY < <(compgen -W "determinant displacement none type" -- "$current") ;;
    -d | --directory | --out | --stages) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    -*) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
    *)
      if [[ -z $command ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
        return
      fi
      case $command in
        demo) mapfile -t COMPREPLY < <(compgen -W "passage ball turbine slat coil aircraft" -- "$current") ;;
        keys) mapfile -t COMPREPLY < <(compgen -W "$("$program" keys 2>/dev/null | sed -n 's/^  \([a-z][a-z_0-9]*\)  .*/\1/p')" -- "$current") ;;
        morph | plan | certify | wheel) mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X '!*.toml' -- "$current") ;;
        *) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
      esac
      ;;
  esac
}

complete -o filenames -F _gridmorph gridmorph
