#!/usr/bin/env bash
# What tools/install-packages, tools/configure, tools/demo and tools/paraview do on machines of all kinds: each function named Like.This is a
# test, run on a machine that fake_machine plays. Usage: packages_test.sh SOURCE TEST; without TEST it lists them.
set -euo pipefail
export DISPLAY=:0
source=$1
here=$(cd "$(dirname "$0")" && pwd)

fail() {
  echo "FAILED: $1"
  echo "--- output:"; cat "$FAKE/output" || true
  echo "--- log:"; cat "$FAKE/log"
  exit 1
}
package() {  # NAME, then other fields
  mkdir -p "$FAKE/packages" "$FAKE/files"
  { echo "Package: $1"; echo "Version: 9.1-5"; printf '%s\n' "${@:2}"; } > "$FAKE/packages/$1"
  : > "$FAKE/files/$1"
}
install() { printf '%s\n' "$@" >> "$FAKE/installed"; }
user_without_sudo() { echo 1000 > "$FAKE/user"; rm "$FAKE/bin/sudo"; }

plain=(g++ cmake ninja-build libgtest-dev libcgal-dev libeigen3-dev libopenmesh-dev libtbb-dev libcli11-dev libfmt-dev
  nlohmann-json3-dev libyaml-cpp-dev libtinyxml2-dev libassimp-dev zlib1g-dev python3-jsonschema xvfb xauth)

# VTK's packages and ParaView's as Debian 12 has them, in short.
set_up() {
  FAKE=$(mktemp -d)
  export FAKE
  trap 'rm -rf "$FAKE"' EXIT
  mkdir -p "$FAKE/bin" "$FAKE/orchard"
  : > "$FAKE/log"; : > "$FAKE/installed"; : > "$FAKE/output"
  echo 0 > "$FAKE/user"
  for program in apt-get apt-cache dpkg-query dpkg id sudo cmake; do ln -s "$here/fake_machine" "$FAKE/bin/$program"; done
  for program in awk bash basename cat cp dirname env find grep ln mkdir mv nproc rm sed sleep sort tee touch tr; do
    ln -s "$(command -v $program)" "$FAKE/bin/$program"
  done
  cp -r "$source/tools" "$FAKE/orchard/tools"
  for name in "${plain[@]}" libglew-dev libgl-dev default-jdk libmpi; do package "$name"; done
  package paraview
  printf '/usr/lib/here/libvtkCommonCore-pv5.so\n/usr/share/doc/paraview\n' > "$FAKE/files/paraview"
  package libvtk9.1 "Source: vtk9" "Depends: libmpi"
  package vtk9 "Depends: libvtk9.1 (= 9.1-5)"
  package python3-vtk9 "Source: vtk9" "Depends: libvtk9.1 (= 9.1-5)"
  package libvtk9-dev "Source: vtk9" \
    "Depends: default-jdk, libgl1-mesa-dev:any | libgl-dev, libglew-dev, libvtk9.1 (= 9.1-5), python3-vtk9 (= 9.1-5), vtk9 (= 9.1-5)"
  package libgl1-mesa-dev
  package python3-paraview "Conflicts: python3-vtk9"
  echo /usr/lib/here/cmake/vtk-9.1/vtk-config.cmake > "$FAKE/files/libvtk9-dev"
  echo /usr/lib/python3/vtk.py > "$FAKE/files/python3-vtk9"
  printf '/usr/bin/pvpython\n/usr/lib/python3/dist-packages/paraview/simple.py\n' > "$FAKE/files/python3-paraview"
  printf '/usr\n/usr/bin\n/usr/bin/env\n' > "$FAKE/files/libvtk9.1"  # something that is at its place on any machine
}
run() { (cd / && PATH=$FAKE/bin "$FAKE/orchard/tools/$1" "${@:2}" > "$FAKE/output" 2>&1); }

expect() { eval "$1" || fail "$1"; }
installed() { grep -qxF "$1" "$FAKE/installed"; }
said() { grep -qF -- "$1" "$FAKE/output"; }
logged() { grep -qF -- "$1" "$FAKE/log"; }
nothing_was_removed() { ! grep -q REMOVED "$FAKE/log"; }
views_are_unpacked() { [ -e "$FAKE/orchard/build/vtk/complete" ]; }

Packages.AreLeftAloneWhereNothingIsMissing() {
  install "${plain[@]}" libvtk9-dev
  expect "run install-packages"
  expect "[ ! -s '$FAKE/log' ]"
}
Packages.ComeFromAptInOneGo() {
  expect "run install-packages"
  for name in "${plain[@]}" libvtk9-dev; do expect "installed $name"; done
  expect "[ $(grep -c 'apt-get install' "$FAKE/log") = 1 ]"
  expect "! views_are_unpacked"
}
Packages.ForTheRunTimeHoldNoVtk() {
  install python3-paraview
  expect "run install-packages runtime"
  expect "installed libgtest-dev"
  expect "! installed libcgal-dev && ! installed libvtk9.1 && ! views_are_unpacked"
}
Packages.ForPythonAreAddedToThoseOfTheBuild() {
  python=(python3-dev python3-numpy pybind11-dev python3-matplotlib python3-setuptools python3-wheel python3-pip
    python3-pytest python3-hypothesis mypy)
  for name in "${python[@]}"; do package "$name"; done
  expect "run install-packages python"
  for name in "${plain[@]}" "${python[@]}"; do expect "installed $name"; done
}
Packages.AreInstalledBySudo() {
  echo 1000 > "$FAKE/user"
  expect "run install-packages"
  expect "installed libvtk9-dev && installed g++"
}
Packages.ThatMayNotBeInstalledAreNamed() {
  user_without_sudo
  install "${plain[@]:1}" libvtk9-dev
  expect "! run install-packages"
  expect "said 'run this as root, or install sudo (missing: g++)'"
}
Packages.OfTheUserAreNeverRemoved() {
  package openmesh-of-the-user "Conflicts: libopenmesh-dev"
  install openmesh-of-the-user
  expect "! run install-packages"
  expect "installed openmesh-of-the-user && nothing_was_removed"
}
Vtk.IsUnpackedBesideParaView() {
  install python3-paraview
  expect "run install-packages"
  expect "installed python3-paraview && nothing_was_removed"
  for name in "${plain[@]}" libglew-dev default-jdk libgl1-mesa-dev libvtk9.1 vtk9; do expect "installed $name"; done
  expect "! installed libvtk9-dev && ! installed python3-vtk9"
  expect "views_are_unpacked"
  expect "[ -f '$FAKE/orchard/build/vtk/usr/lib/here/cmake/vtk-9.1/vtk-config.cmake' ]"
  expect "[ -f '$FAKE/orchard/build/vtk/usr/lib/python3/vtk.py' ]"
  expect "[ '$FAKE/orchard/build/vtk/usr/bin/env' -ef /usr/bin/env ]"
  expect "! ls '$FAKE'/orchard/build/vtk/*.deb"
}
Vtk.IsUnpackedBySudoToo() {
  echo 1000 > "$FAKE/user"
  install python3-paraview "${plain[@]}"
  expect "run install-packages"
  expect "views_are_unpacked && installed libglew-dev"
  expect "logged '(user 1000)'"  # the download
}
Vtk.IsUnpackedOnce() {
  install python3-paraview
  expect "run install-packages"
  expect "views_are_unpacked"
  : > "$FAKE/log"
  expect "run install-packages"
  expect "[ ! -s '$FAKE/log' ]"
}
Vtk.IsUnpackedAgainWhereALinkLeadsNowhere() {
  install python3-paraview
  expect "run install-packages"
  ln -s /nowhere/libvtkCore.so "$FAKE/orchard/build/vtk/usr/lib/libvtkCore.so"
  expect "run install-packages"
  expect "views_are_unpacked && [ ! -L '$FAKE/orchard/build/vtk/usr/lib/libvtkCore.so' ]"
}
Vtk.ThatCannotBeDownloadedMeansNoViews() {
  install python3-paraview "${plain[@]}" default-jdk libgl1-mesa-dev libglew-dev libvtk9.1 vtk9
  touch "$FAKE/offline"
  expect "run install-packages"
  expect "said 'No views and pictures' && ! views_are_unpacked"
  expect "installed python3-paraview && nothing_was_removed"
}
Vtk.ThatIsNotWholeMeansNoViews() {
  install python3-paraview
  echo /usr/lib/nowhere/libvtkCommonCore.so.1 >> "$FAKE/files/libvtk9.1"
  expect "run install-packages"
  expect "said 'No views and pictures' && said libvtkCommonCore.so.1 && ! views_are_unpacked"
}
Vtk.WhoseOwnNeedsConflictMeansNoViews() {
  package glew-of-the-user "Conflicts: libglew-dev"
  install glew-of-the-user
  expect "run install-packages"
  expect "said 'No views and pictures' && installed glew-of-the-user && nothing_was_removed"
  for name in "${plain[@]}"; do expect "installed $name"; done
}
Vtk.ThatAptDoesNotKnowMeansNoViews() {
  rm "$FAKE/packages/libvtk9-dev"
  expect "run install-packages"
  expect "said 'No views and pictures' && installed g++"
}
Vtk.ThatMayNotBeInstalledMeansNoViews() {
  user_without_sudo
  install "${plain[@]}"
  expect "run install-packages"
  expect "said 'No views and pictures'"
}
Configure.BuildsViewsWhereVtkIs() {
  expect "run configure release"
  expect "logged 'cmake --preset release -DORCHARD_VIZ=ON' && ! logged ORCHARD_VIZ=OFF && ! said 'without views'"
}
Configure.SaysThatThereAreNoViews() {
  touch "$FAKE/no_vtk_in_cmake"
  expect "run configure release"
  expect "logged ORCHARD_VIZ=OFF && said 'Building without views and pictures'"
  expect "grep -q 'no VTK' '$FAKE/orchard/build/release/configure.log'"
}
Configure.FailsWithCMakesWordsWhereViewsAreNotToBlame() {
  touch "$FAKE/no_cmake"
  expect "! run configure release"
  expect "said 'CMake Error: no compiler'"
}
Configure.OfTheBenchmarksInstallsTheirRivals() {
  for name in libbenchmark-dev libembree-dev libfcl-dev libbullet-dev; do package $name; done
  expect "run configure bench"
  expect "installed libembree-dev"
}
Demo.MakesPicturesWhereVtkIs() {
  expect "run demo"
  expect "logged 'orchard build data/ship.obj -o out/ship --picture' && logged orchard_render && said 'Open in ParaView'"
}
Demo.MakesTreesWithoutVtk() {
  touch "$FAKE/no_vtk_in_cmake"
  expect "run demo"
  expect "logged 'orchard build data/ship.obj -o out/ship' && ! logged --picture && ! logged orchard_render"
  expect "! said 'Open in ParaView'"
}

ParaView.ThatIsNotThereIsSaid() {
  expect "! run paraview pvbatch --version"
  expect "said 'apt-get install --no-install-recommends paraview'"
}
ParaView.RunsItsPythonBesideVtk() {
  install paraview libvtk9-dev python3-vtk9
  ln -s "$here/fake_machine" "$FAKE/bin/pvbatch"
  expect "run paraview pvbatch script.py 'with blanks'"
  folder=$FAKE/orchard/build/paraview
  expect "logged '$folder/usr/bin/pvbatch script.py with blanks with $folder/usr/lib/python3/dist-packages on :0'"
  expect "[ -L '$folder/usr/lib/here/libvtkCommonCore-pv5.so' ] && [ -f '$folder/usr/bin/pvpython' ]"
  expect "installed python3-vtk9 && ! installed python3-paraview && nothing_was_removed && ! logged 'apt-get install'"
  : > "$FAKE/log"
  expect "run paraview pvbatch again.py"
  expect "logged again.py && ! logged apt-get"
}
ParaView.RunsItsOwnPythonWhereThatIsInstalled() {
  install paraview python3-paraview
  ln -s "$here/fake_machine" "$FAKE/bin/pvpython"
  expect "run paraview pvpython script.py"
  expect "logged 'pvpython script.py with nothing' && ! logged apt-get"
}
ParaView.RunsOnAVirtualDisplayWhereThereIsNone() {
  install paraview python3-paraview
  unset DISPLAY
  ln -s "$here/fake_machine" "$FAKE/bin/pvbatch"
  expect "! run paraview pvbatch script.py"
  expect "said 'no Xvfb'"
  ln -s "$here/fake_machine" "$FAKE/bin/Xvfb"
  expect "run paraview pvbatch script.py"
  expect "logged 'script.py with nothing on :47'"
  status=0
  run paraview pvbatch fails.py || status=$?
  expect "[ $status = 7 ]"
  for ((i = 0; i < 100; ++i)); do
    if [ "$(grep -c 'Xvfb ended' "$FAKE/log")" = 2 ]; then break; fi
    sleep 0.1
  done
  expect "[ $(grep -c 'Xvfb ended' "$FAKE/log") = 2 ]"
}
ParaView.ThatCannotBeHadSaysSo() {
  install paraview
  touch "$FAKE/offline"
  expect "! run paraview pvpython script.py"
  expect "said 'cannot be downloaded'"
}

if [ $# -eq 1 ]; then
  declare -F | sed -nE 's/^declare -f ([A-Z][A-Za-z]+\.[A-Za-z]+)$/\1/p'
else
  set_up
  "$2"
fi
