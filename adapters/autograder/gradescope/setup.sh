#!/usr/bin/env bash
# Gradescope runs this once, as root, when it builds the image.
set -euo pipefail

source=/autograder/source

apt-get update
DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends build-essential cmake ccache

install -m 755 "$source/furnace" /usr/local/bin/furnace
if ! furnace --version; then
  echo "The furnace in this zip does not run on this image: it was built for another system." >&2
  echo "Build it on this image or an older one, put it in the zip in its place, and upload that again." >&2
  exit 1
fi

# Submissions are built by somebody who can read neither the salt nor the results.
id student >/dev/null 2>&1 || useradd --create-home student
chmod 700 "$source"

# Unpacked once here, and not for every submission.
FURNACE_CACHE=/opt/furnace furnace lint --project "$source"
chmod -R a+rX /opt/furnace
