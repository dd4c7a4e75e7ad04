#!/usr/bin/env bash
# What the launcher promises, on a copy of it whose apt-get, cmake, ninja and ctest are stand-ins that write down how
# they were called. PATH holds nothing but them and links to the system's basic tools.
# usage: launcher_test.sh LAUNCHER CASE
set -euo pipefail
launcher=$(readlink -f -- "$1")
source_root=$(dirname -- "$launcher")
case_name=$2

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
checkout="$work/a path with spaces"
bin=$work/bin
export CALLS=$work/calls STATE=$work/state
mkdir -p "$checkout/cmake" "$bin" "$STATE"
: >"$CALLS"
cp -- "$launcher" "$checkout/cdem"
cp -- "$source_root/cmake/packages.txt" "$checkout/cmake/"
for folder in apps libcdem libgeom lua tests examples; do mkdir "$checkout/$folder" && touch "$checkout/$folder/a.cpp"; done
touch "$checkout/CMakeLists.txt" "$checkout/CMakePresets.json"
chmod -R a+rwX "$work"

for tool in bash sh env awk sed comm sort paste cut wc find flock nproc stty tail mv rm mkdir readlink dirname grep \
  cat sleep touch chmod id; do
  ln -s "$(command -v "$tool")" "$bin/$tool"
done
stand_in() { # name; body from stdin
  # shellcheck disable=SC2016 # expanded when it is called
  { printf '#!/usr/bin/env bash\necho "%s $*" >>"$CALLS"\n' "$1" && cat; } >"$bin/$1"
  chmod a+rx "$bin/$1"
}
# Everything is installed but the packages named in $STATE/missing.
stand_in dpkg-query <<'TOOL'
shift 3
for package; do grep -qx "$package" "$STATE/missing" 2>/dev/null || echo "installed $package"; done
TOOL
stand_in apt-get <<'TOOL'
echo "apt's own words"
[[ $1 == install ]] || exit 0
[[ ! -e $STATE/apt_fails ]] || exit 100
rm -f "$STATE/missing"
TOOL
stand_in cmake <<'TOOL'
echo "cmake's own words"
[[ ! -e $STATE/cmake_fails ]] || exit 1
mkdir -p build/release && touch build/release/build.ninja
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt
TOOL
stand_in ninja <<'TOOL'
echo "[1/1] Building"
[[ ! -e $STATE/ninja_fails ]] || { echo "a.cpp:1: error" && exit 1; }
sleep 0.2
mkdir -p bin
for program in cdem cdem_bench; do
  printf '#!/usr/bin/env bash\necho "%s in $PWD:"; printf "<%%s>" "$@"; echo\n%s\n' "$program" \
    '[[ ${1:-} != sleep ]] || exec sleep 20; exit "${PROGRAM_ENDS:-0}"' >bin/$program
  chmod a+rx bin/$program
done
TOOL
stand_in sudo <<<'exec "$@"'
stand_in ctest <<'TOOL'
printf '<%s>' "$@"; exit "${PROGRAM_ENDS:-0}"
TOOL

cdem() { # runs the launcher; sets out, err, rc
  rc=0
  PATH=$bin "$checkout/cdem" "$@" >"$work/out" 2>"$work/err" </dev/null || rc=$?
  out=$(<"$work/out") err=$(<"$work/err")
}
cdem_not_root() {
  rc=0
  local drop=()
  ((EUID != 0)) || drop=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  "${drop[@]}" env PATH="$bin" "$checkout/cdem" "$@" >"$work/out" 2>"$work/err" </dev/null || rc=$?
  out=$(<"$work/out") err=$(<"$work/err")
}
expect() { # description, then a command that must succeed
  local what=$1
  shift
  "$@" || {
    printf 'FAILED: %s\nrc=%s\n-- out\n%s\n-- err\n%s\n-- calls\n%s\n' "$what" "$rc" "$out" "$err" "$(<"$CALLS")"
    exit 1
  }
}
equal() { [[ $1 == "$2" ]]; }
contains() { [[ $1 == *"$2"* ]]; }
called() { grep -q "^$1" "$CALLS"; }
not() { ! "$@"; }
later() { sleep 0.02; } # longer than a tick of the file system's clock

case $case_name in
  first_call_installs_configures_builds_and_runs)
    printf 'catch2\ncmake\n' >"$STATE/missing"
    cd "$work"
    cdem run "a file.lua" --set 'p=1 *' ''
    expect "success" equal "$rc" 0
    expect "stdout is the program's, arguments and folder as given" \
      equal "$out" "cdem in $work:"$'\n'"<run><a file.lua><--set><p=1 *><>"
    expect "lists are refreshed first" equal "$(grep -m1 ^apt-get "$CALLS" | cut -d' ' -f1-2)" "apt-get update"
    expect "only what is missing is installed" grep -q '^apt-get install .* catch2 cmake$' "$CALLS"
    expect "apt's output goes to the log" grep -q "own words" "$checkout/build/install.log"
    expect "it is said at once how long it takes" contains "$(head -n 1 "$work/err")" "minutes; later calls start at once"
    expect "the goal is the program alone" grep -q '^ninja .* cdem_program$' "$CALLS"
    ;;
  nothing_is_asked_when_nothing_changed)
    cdem info
    : >"$CALLS"
    cdem info
    expect "success" equal "$rc" 0
    expect "no tool is called" equal "$(<"$CALLS")" ""
    expect "nothing is said" equal "$err" ""
    ;;
  a_changed_new_or_deleted_source_is_built)
    cdem info
    for change in "touch libgeom/a.cpp" "touch lua/new.cpp" "rm libcdem/a.cpp"; do
      : >"$CALLS"
      later
      (cd "$checkout" && $change)
      cdem info
      expect "ninja runs after: $change" called ninja
      expect "no package is installed, nothing configured" not grep -qE '^(apt-get|cmake)' "$CALLS"
    done
    : >"$CALLS"
    later
    touch "$checkout/tests/a.cpp"
    cdem info
    expect "a test's source is none of the program's" not called ninja
    ;;
  without_root_and_sudo_the_message_has_the_command)
    echo catch2 >"$STATE/missing"
    rm "$bin/sudo"
    cdem_not_root info
    expect "exit code" equal "$rc" 5
    expect "one line" equal "$(wc -l <"$work/err")" 1
    expect "the command" contains "$err" \
      "apt-get update && apt-get install -y --no-install-recommends catch2"
    expect "nothing is tried" not called apt-get
    ;;
  sudo_is_used_when_not_root)
    echo catch2 >"$STATE/missing"
    cdem_not_root info
    expect "success" equal "$rc" 0
    expect "through sudo" called 'sudo env DEBIAN_FRONTEND=noninteractive'
    expect "installed" called 'apt-get install'
    ;;
  failing_apt_shows_its_log)
    echo catch2 >"$STATE/missing"
    touch "$STATE/apt_fails"
    cdem info
    expect "exit code" equal "$rc" 5
    expect "the log's end" contains "$err" "apt's own words"
    expect "the command for root" contains "$err" "install -y --no-install-recommends catch2"
    ;;
  other_systems_are_told_and_tried)
    rm "$bin/apt-get"
    cdem info
    expect "success" equal "$rc" 0
    expect "is told" contains "$err" "not a Debian system"
    ;;
  failing_configuration_and_build_are_tried_again)
    touch "$STATE/cmake_fails"
    cdem info
    expect "exit code" equal "$rc" 5
    expect "cmake's words" contains "$err" "cmake's own words"
    rm "$STATE/cmake_fails" && touch "$STATE/ninja_fails"
    cdem info
    expect "exit code" equal "$rc" 5
    expect "the compiler's words" contains "$err" "a.cpp:1: error"
    expect "program not run" equal "$out" ""
    rm "$STATE/ninja_fails"
    cdem info
    expect "success" equal "$rc" 0
    ;;
  exit_codes_pass_through)
    for code in 0 1 2 3 4 130; do
      PROGRAM_ENDS=$code cdem run x.lua
      expect "program's" equal "$rc" "$code"
    done
    PROGRAM_ENDS=8 cdem test
    expect "ctest's" equal "$rc" 8
    ;;
  signals_reach_the_program)
    cdem info
    PATH=$bin "$checkout/cdem" sleep >/dev/null &
    pid=$!
    for _ in {1..100}; do
      if [[ $(tr '\0' ' ' <"/proc/$pid/cmdline") == "sleep 20 " ]]; then break; fi
      sleep 0.05
    done
    expect "the program has the launcher's process" equal "$(tr '\0' ' ' <"/proc/$pid/cmdline")" "sleep 20 "
    kill -TERM "$pid"
    rc=0 && wait "$pid" || rc=$?
    expect "ended by the signal" equal "$rc" 143
    ;;
  help_works_before_anything_is_built)
    echo catch2 >"$STATE/missing"
    for word in "" --help -h help; do
      cdem ${word:+"$word"}
      expect "success" equal "$rc" 0
      expect "test and bench" contains "$out" "./cdem bench"
      expect "says so" contains "$out" "not built yet"
      expect "nothing is called" equal "$(<"$CALLS")" ""
    done
    cdem info && cdem --help
    expect "the program's own help comes first" equal "${out%%:*}" "cdem in $PWD"
    expect "then the launcher's" contains "$out" "./cdem bench"
    ;;
  a_moved_checkout_is_configured_again)
    cdem info
    : >"$CALLS"
    mv "$checkout" "$work/moved"
    checkout=$work/moved
    cdem info
    expect "success" equal "$rc" 0
    expect "configured" called "cmake --preset release"
    expect "built" called ninja
    ;;
  test_bench_and_setup)
    cdem test -R 'a b'
    expect "ctest's arguments" contains "$out" "<--output-on-failure>"
    expect "ours are handed on" contains "$out" "<-R><a b>"
    expect "all is built" grep -q '^ninja .* all$' "$CALLS"
    cdem bench --benchmark_filter=x
    expect "arguments" equal "$out" "cdem_bench in $PWD:"$'\n'"<--benchmark_filter=x>"
    echo shellcheck >"$STATE/missing"
    cdem info
    expect "lint packages are not the user's" not called apt-get
    cdem setup lint
    expect "but the developer's" grep -q '^apt-get install .* shellcheck$' "$CALLS"
    cdem setup lnit
    expect "unknown group" equal "$rc" 2
    expect "names them" contains "$err" "build, convert, docs, lint, package, clang"
    ;;
  two_first_calls_build_once)
    PATH=$bin "$checkout/cdem" info >"$work/out1" 2>&1 &
    cdem info
    expect "success" equal "$rc" 0
    rc=0 && wait $! || rc=$?
    expect "success of the other" equal "$rc" 0
    expect "one build" equal "$(grep -c ^ninja "$CALLS")" 1
    ;;
  *)
    echo "no case $case_name" && exit 1
    ;;
esac
