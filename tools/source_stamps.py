"""What checks of sources share that take longer than a run may: what changed last comes first, and what passed is not looked
at again until it, a header it includes or the configuration changes.
"""
import hashlib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def changed_files(since: str) -> list[str]:
    done = subprocess.run(["git", "-C", ROOT, "diff", "--name-only", since], capture_output=True,
                          text=True, check=True)
    return done.stdout.split()


def newest_first(files: list[str]) -> list[str]:
    """What is not committed, then by the time of the last commit that touched it."""
    log = subprocess.run(["git", "-C", ROOT, "log", "--format=%x00%ct", "--name-only", "--no-renames"],
                         capture_output=True, text=True, check=True).stdout
    touched: dict[str, int] = {}
    for commit in log.split("\0")[1:]:
        when, *names = commit.split("\n")
        for name in filter(None, names):
            touched.setdefault(name, int(when))
    touched |= dict.fromkeys(changed_files("HEAD"), sys.maxsize)
    return sorted(files, key=lambda file: (-touched.get(file, sys.maxsize), file))


def fingerprint(file: str, seen: dict[str, str], configuration: bytes) -> str:
    """Changes with the source, the project headers it reaches, and the configuration."""
    pending, texts = [file], {}
    while pending:
        name = pending.pop()
        if name in texts or not (ROOT / name).is_file():
            continue
        if name not in seen:
            seen[name] = (ROOT / name).read_text(encoding="utf-8")
        texts[name] = seen[name]
        pending += re.findall(r'^\s*#\s*include\s+"([^"]+)"', seen[name], re.MULTILINE)
    digest = hashlib.sha256(configuration)
    for name in sorted(texts):
        digest.update(name.encode() + b"\0" + texts[name].encode())
    return digest.hexdigest()


def due_files(files: list[str], stamps: Path, configuration: bytes, force: bool = False) -> list[tuple[str, Path]]:
    """Those that have no stamp, with the stamp to touch when they pass."""
    stamps.mkdir(parents=True, exist_ok=True)
    seen: dict[str, str] = {}
    stamped = [(file, stamps / fingerprint(file, seen, configuration)) for file in files]
    return [(file, stamp) for file, stamp in stamped if force or not stamp.exists()]
