"""What a mapper rests on, so that results of different mappers are never added up.

A catalogue algorithm rests on topo_verify alone; a user's mapper on every file that its process
loaded or read, and on the values it was made with (programs/loaded.py); a program on the files
that its command or `--depends` names. No such list is complete, so some shards of a store are
examined again.
"""

from __future__ import annotations

import importlib.machinery
import os
import shutil
import sys
from collections.abc import Iterable, Sequence
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path

from topo_verify import errors
from topo_verify.algorithms import Algorithm, Steered
from topo_verify.errors import InputError, shown
from topo_verify.programs import loaded
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.library import LIBRARY, library_file
from topo_verify.programs.loaded import Loaded, values_hash
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX, Program, split

_PACKAGE = Path(errors.__file__).resolve().parent


# ---------------------------------------------------------------- before


def source_hash(mappers: Iterable[Target]) -> str:
    """A hash of topo_verify and of the files that name these mappers, as they are now."""
    digest = sha256(own_hash().encode())
    for mapper in mappers:
        if not isinstance(mapper.mapper, Algorithm | Steered):
            for path, hashed in sorted(loaded.hashes(named_files(mapper.text)).items()):
                digest.update(f"\0{path}\0{hashed}".encode(errors="surrogateescape"))
    return digest.hexdigest()


@cache
def own_hash() -> str:
    """The hash of topo_verify's sources when this process first asked."""
    digest = sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        digest.update(f"\0{path.relative_to(_PACKAGE)}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def named_files(text: str) -> list[str]:
    """The files that a TARGET names: of a program, a library or a Python mapper."""
    if text.startswith(LIBRARY):
        return [library_file(text)[0]]
    if text.startswith(PREFIX):
        words = split(text.removeprefix(PREFIX))
        return [shutil.which(words[0]) or words[0], *words[1:]]
    place = text.rpartition(":")[0]
    file = place if place.endswith(".py") else _module_file(place)
    return [file] if file else []


def _module_file(name: str) -> str | None:
    """The file of a module, found without running its package."""
    folders: list[str] | None = [str(Path.cwd()), *sys.path]
    spec = None
    for part in name.split("."):
        spec = importlib.machinery.PathFinder.find_spec(part, folders)
        if spec is None:
            return None
        folders = list(spec.submodule_search_locations or ())
    return spec.origin if spec is not None else None


def runs_here(target: Target) -> bool:
    """Whether a user's mapper runs in this process, where it could replace checkers."""
    return not isinstance(target.mapper, Algorithm | Steered | Program)


# ---------------------------------------------------------------- in the course of a search


class Identity:
    """What a campaign's mappers rest on in this process; made before any of them runs."""

    def __init__(self, mappers: Sequence[Target], depends: Sequence[str] = ()) -> None:
        self._mappers, self.depends = mappers, tuple(depends)
        self._values = " ".join(values_hash(m.mapper) for m in mappers if runs_here(m))

    def loaded(self) -> Loaded:
        """What they have loaded until now."""
        files = Loaded(loaded.hashes(self.depends))
        for target in self._mappers:
            files = merged(files, self._of(target), f"target {target.text!r}")
        return files

    def _of(self, target: Target) -> Loaded:
        mapper = target.mapper
        if isinstance(mapper, Algorithm | Steered):
            return Loaded()
        if isinstance(mapper, Foreign):
            return mapper.loaded()
        if isinstance(mapper, Program):
            return Loaded(loaded.hashes(named_files(target.text)))
        return loaded.loaded(self._values)


def merged(first: Loaded, second: Loaded, where: str) -> Loaded:
    """What either has loaded. InputError, which begins with `where`, if the two disagree."""
    for path, digest in second.files.items():
        if first.files.get(path, digest) != digest:
            raise InputError(
                f"{where}: the mapper read {shown(path)}, which changed while the search ran: start"
                " the search again"
            )
    if first.values and second.values and first.values != second.values:
        raise InputError(
            f"{where}: the mapper is made with other values each time (arguments of a partial, a"
            " closure, defaults): give it the same ones, or search without a ledger"
        )
    for name, path in second.modules.items():
        if (known := first.modules.get(name, path)) != path:
            raise InputError(
                f"{where}: the mapper's module {shown(name)} is {shown(known)} in one process and"
                f" {shown(path)} in another: give all the same search path for modules"
            )
    return Loaded(
        {**first.files, **second.files},
        {**first.distributions, **second.distributions},
        first.values or second.values,
        {**first.modules, **second.modules},
    )


def require_equal(here: Loaded, there: Loaded, where: str) -> None:
    """Raise an InputError unless everything that mappers loaded elsewhere is the same here."""
    if here.values and there.values and here.values != there.values:
        raise InputError(
            f"{where}: the mapper is made with other values there (arguments of a partial, a"
            " closure, defaults): give it the same ones in every process"
        )
    for path, digest in there.files.items():
        known = loaded.file_hash(path)
        if known != digest:
            fault = "is another file here" if known else "is not a file here"
            raise InputError(
                f"{where}: the mapper read {shown(path)}, which {fault}: give every machine the"
                " same files, and restart the workers"
            )
    for name, version in there.distributions.items():
        if (installed := _version(name)) != version:
            raise InputError(
                f"{where}: the mapper used {name} {version}, installed here is"
                f" {installed or 'none'}: install the same version on every machine"
            )
    merged(here, there, where)


# ---------------------------------------------------------------- before it goes on


class MapperChanged(InputError):
    """What a mapper rests on has changed since its results were kept; `change` says how."""

    def __init__(self, where: str, change: str) -> None:
        super().__init__(f"{where}: {change}; name another file or folder, or remove this one")
        self.change = change


def require_unchanged(then: Loaded, now: Loaded, where: str) -> None:
    """Raise MapperChanged unless files, versions and values are unchanged."""
    if then.values and now.values and then.values != now.values:
        raise MapperChanged(
            where,
            "the mapper was made with other values (arguments of a partial, a closure, defaults)",
        )
    for path, digest in then.files.items():
        if loaded.file_hash(path) != digest:
            change = "has changed" if os.path.exists(path) else "is gone"  # noqa: PTH110
            raise MapperChanged(where, f"{shown(path)}, which the mapper read, {change}")
    for name, version in then.distributions.items():
        installed = _version(name)
        if installed != version:
            raise MapperChanged(
                where, f"the mapper used {name} {version}, installed is {installed or 'none'}"
            )


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None
