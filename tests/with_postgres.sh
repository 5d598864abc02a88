#!/usr/bin/env bash
# Run a command with a PostgreSQL server of its own: tests/with_postgres.sh COMMAND...
# The server lives in a temporary folder and ends with the command, whose exit code this has. The command finds the
# server's URL in FETCH_POMDP_TEST_DATABASE.
set -euo pipefail

(($#)) || { echo 'usage: tests/with_postgres.sh COMMAND...' >&2; exit 2; }
programs=$(ls -d /usr/lib/postgresql/*/bin 2>/dev/null | sort -V | tail -n 1)
[[ -n $programs ]] || programs=$(dirname "$(command -v initdb || true)")
[[ -x $programs/initdb ]] || { echo 'PostgreSQL is not installed; install it with: apt install postgresql' >&2; exit 2; }

folder=$(mktemp -d)
as_owner=()
if ((EUID == 0)); then # PostgreSQL refuses to run as root
  as_owner=(runuser -u postgres --)
  chown postgres "$folder"
fi
server() { (cd / && "${as_owner[@]}" "$programs/pg_ctl" -D "$folder/data" -s "$@"); }
finish() {
  server -m immediate stop 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 130' INT TERM

password=$(od -An -N12 -tx1 /dev/urandom | tr -d ' \n')
(umask 077 && echo "$password" >"$folder/password")
((EUID != 0)) || chown postgres "$folder/password"
(cd / && "${as_owner[@]}" "$programs/initdb" -D "$folder/data" -U tester --pwfile="$folder/password" \
  --auth-local=trust --auth-host=scram-sha-256 -E UTF8 --locale=C >/dev/null)

for _ in 1 2 3 4 5; do # a free port may be taken before the server has it
  port=$((20000 + RANDOM % 12000))
  options="-c listen_addresses=127.0.0.1 -c port=$port -c unix_socket_directories=$folder"
  if server -l "$folder/log" -o "$options" -w start; then break; fi
done
server status >/dev/null || { cat "$folder/log" >&2; exit 1; }

export FETCH_POMDP_TEST_DATABASE="postgresql+psycopg://tester:$password@127.0.0.1:$port/postgres"
"$@"
