#!/usr/bin/env python3
"""A blind challenge as two people play it: one seals, the other analyses, both see the score.

Usage: run_seal.py PIRSIM DATA_DIRECTORY FAILING_CALLS_LIBRARY
"""
import csv
import errno
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile


def main():
    pirsim, data, failing_calls = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
    study = ["--scene", str(data / "rooms/meeting_room.gltf"), "--script", str(data / "studies/studyA.yaml")]

    def call(*words, code=0, env=None):
        result = subprocess.run([pirsim, "reconcile", *map(str, words)], capture_output=True, text=True, env=env)
        assert result.returncode == code, (words, result.returncode, result.stdout, result.stderr)
        return result

    def sealed(folder, kind, seed):
        shutil.rmtree(folder / "public", ignore_errors=True)
        (folder / "answer.json").unlink(missing_ok=True)
        call("seal", *study, "--hide", kind, "--secret-seed", seed, "-o", folder / "public", "--answer",
             folder / "answer.json")
        return json.loads((folder / "answer.json").read_text())

    def opened(folder, verdict, effects, code=0, digest=None):
        digest = digest or hashlib.sha256((folder / "public/measured.csv").read_bytes()).hexdigest()
        (folder / "report.json").write_text(json.dumps(
            {"pirsim_reconcile_report": 1, "verdict": verdict, "effects": effects, "measured": {"sha256": digest}}))
        return call("open", "--answer", folder / "answer.json", "--commitment", folder / "public/commitment.sha256",
                    "--report", folder / "report.json", code=code)

    with tempfile.TemporaryDirectory() as name:
        one, two = pathlib.Path(name) / "one", pathlib.Path(name) / "two"
        one.mkdir()
        two.mkdir()
        answer = sealed(one, "one", 7)
        effect = answer["effects"][0]["name"]

        # The hash is that of the answer's bytes by another implementation; what is published tells nothing else.
        published = (one / "public/commitment.sha256").read_text()
        assert published.split() == [hashlib.sha256((one / "answer.json").read_bytes()).hexdigest(), "answer.json"]
        assert sorted(f.name for f in (one / "public").iterdir()) == ["commitment.sha256", "measured.csv"]
        rows = (one / "public/measured.csv").read_text()
        assert effect not in rows and answer["salt"] not in rows
        assert answer["measured_sha256"] == hashlib.sha256(rows.encode()).hexdigest()
        plain = subprocess.run([pirsim, *study, "--set", "replicates=1"], capture_output=True, text=True, check=True)
        # ... nor how many people were there, which nobody measures and which would tell a hidden one.
        assert rows.splitlines()[0] == plain.stdout.splitlines()[0].replace(",people,", ",")

        # Same secret: same data and effect, but another salt, so another hash.
        again = sealed(two, "one", 7)
        assert (two / "public/measured.csv").read_text() == rows
        assert again["effects"] == answer["effects"] and again["salt"] != answer["salt"]
        assert (two / "public/commitment.sha256").read_text() != published

        # Marks.
        other = "clock_lag" if effect != "clock_lag" else "body_size"
        assert opened(one, "named", [effect]).stdout.startswith("exact:")
        assert opened(one, "one-of", [effect, other]).stdout.startswith("one-of:")
        assert opened(one, "named", ["labels_swapped" if effect != "labels_swapped" else "body_size"]).stdout.split(
            ":")[0] in ("wrong", "family")
        assert opened(one, "several", [effect, other]).stdout.split(":")[0] in ("wrong", "family")
        assert opened(one, "none-in-catalogue", []).stdout.startswith("none:")
        assert "other data" in opened(one, "named", [effect], code=3, digest="0" * 64).stderr

        # Whoever changes the answer afterwards is found out, whatever they change.
        honest = (one / "answer.json").read_text()
        for old, new in ((effect, other), (answer["salt"], "0" * 32), ("}\n", "}\n\n")):
            assert old in honest
            (one / "answer.json").write_text(honest.replace(old, new))
            assert "committed" in opened(one, "named", [effect], code=3).stderr
        (one / "answer.json").write_text(honest)
        opened(one, "named", [effect])

        fault = sealed(two, "out-of-catalogue", 3)
        assert fault["effects"] == [] and fault["out_of_catalogue_fault"]["name"]
        assert opened(two, "none-in-catalogue", []).stdout.startswith("exact:")
        assert opened(two, "named", ["clock_lag"]).stdout.startswith("wrong:")
        assert opened(two, "no-disagreement", []).stdout.startswith("none:")
        pair = sealed(two, "two", 5)
        names = [e["name"] for e in pair["effects"]]
        assert len(set(names)) == 2
        assert opened(two, "several", names).stdout.startswith("exact:")
        assert opened(two, "named", names[:1]).stdout.startswith("part:")
        assert sealed(two, "nothing", 5)["effects"] == []
        assert opened(two, "no-disagreement", []).stdout.startswith("exact:")
        assert opened(two, "named", ["clock_lag"]).stdout.startswith("wrong:")

        # The analysis has no way to be told of an answer, and takes it for no data.
        assert call(*study, "--measured", one / "answer.json", "-o", pathlib.Path(name) / "out", code=3)
        call(*study, "--measured", one / "public/measured.csv", "--answer", one / "answer.json", code=2)
        call("seal", *study, "-o", one / "x", code=2)

        # What was committed to is never lost, and the answer is not handed over with the data.
        before = {file: file.read_bytes() for file in one.rglob("*") if file.is_file()}
        for out, secret in ((one / "public", two / "new.json"), (two / "new", one / "answer.json")):
            assert "isn't overwritten" in call("seal", *study, "-o", out, "--answer", secret, code=2).stderr
        assert {file: file.read_bytes() for file in one.rglob("*") if file.is_file()} == before
        assert "secret" in call("seal", *study, "-o", two / "new", "--answer", two / "new/answer.json", code=2).stderr
        assert not (two / "new").exists() and not (two / "new.json").exists()

        # No file of anybody's is overwritten, and the answer isn't handed over however deep it lies.
        notes = two / "mine/measured.csv"
        notes.parent.mkdir()
        notes.write_text("my own")
        assert "isn't overwritten" in call("seal", *study, "-o", notes.parent, "--answer", two / "new.json",
                                           code=2).stderr
        assert notes.read_text() == "my own" and not (two / "new.json").exists()
        notes.unlink()
        (two / "link").symlink_to(two / "mine")
        for out, secret in (("new", "new/deep/answer.json"), ("new/", "new/answer.json"), ("new", "new"),
                            ("link", "mine/sub/answer.json"), ("mine", "link/sub/answer.json"),
                            ("new/../new", "mine/../new/sub/answer.json")):
            refused = call("seal", *study, "-o", f"{two}/{out}", "--answer", f"{two}/{secret}", code=2).stderr
            assert "secret" in refused, (out, secret, refused)

        # What fails leaves nothing in the way of the next try.
        def fails(out, secret, env=None):
            before = sorted(two.rglob("*.*"))
            message = call("seal", *short, "-o", out, "--answer", secret, code=4, env=env).stderr
            assert sorted(two.rglob("*.*")) == before, (message, sorted(two.rglob("*.*")))
            return message

        short = [*study, "--set", "trials.for_each.seat=[S1]"]
        (two / "plain").write_text("a file")
        assert "plain" in fails(two / "plain", two / "new.json")
        assert "nowhere" in fails(two / "next", two / "nowhere/new.json")
        assert not (two / "next").exists()
        failing = {**os.environ, "LD_PRELOAD": failing_calls, "ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0",
                   "PIRSIM_FAIL_ERRNO": str(int(errno.ENOSPC))}
        for what in ("open", "rename", "write"):
            for at in (1, 2, 3):  # answer, rows, hash
                message = fails(two / "next", two / "new.json",
                                {**failing, "PIRSIM_FAIL_CALL": what, "PIRSIM_FAIL_AT": str(at)})
                assert "No space left" in message, message
        call("seal", *short, "-o", two / "next", "--answer", two / "new.json", "--secret-seed", 7)
        assert sorted(f.name for f in (two / "next").iterdir()) == ["commitment.sha256", "measured.csv"]

        # Nothing can be hidden that the script has: that is told, not searched for ever.
        listed = subprocess.run([pirsim, "effects", "--format", "csv"], capture_output=True, text=True, check=True)
        every = sorted({row["effect"] for row in csv.DictReader(listed.stdout.splitlines())})
        has_all = "effects=[" + ", ".join(f"{{{name}: {{}}}}" for name in every) + "]"
        refused = call("seal", *study, "--set", has_all, "--hide", "one", "-o", two / "none", "--answer",
                       two / "none.json", code=2).stderr
        assert "can't be hidden" in refused and not (two / "none").exists(), refused

        # What a report says that isn't known isn't scored, and the file is named.
        opened(one, "named", [effect])
        for verdict, effects, what in (("nonsense", [], "nonsense"), ("named", ["dead_senser"], "dead_sensor")):
            refused = opened(one, verdict, effects, code=3).stderr
            assert str(one / "report.json") in refused and what in refused, refused
        # How often trials are run is --runs, and the secret seed decides: no option that does nothing is offered.
        for option in ("--replicates", "--seed"):
            assert option in call("seal", *study, option, 7, "-o", two / "x", "--answer", two / "x.json", code=2).stderr

        # Messages that say what is wrong.
        refused = call("seal", *study, "-o", two / "new", "--answer", two / "new.json", "--hide", "twoo", code=2).stderr
        assert "expected one of" in refused and "two" in refused, refused
        refused = call("open", "--answer", one / "answer.json", "--commitment", one / "public/measured.csv", "--report",
                       one / "report.json", code=3).stderr
        assert "64 hexadecimal digits" in refused, refused


if __name__ == "__main__":
    main()
