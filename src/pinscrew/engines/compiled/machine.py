"""From a module of instructions to a function to call: compiled for this processor, and kept on disk.

What was compiled is found again by the instructions themselves, the system, the processor and the compiler's
version, so a later process loads it in milliseconds. Files appear whole (written aside, then renamed), so processes
that compile the same at once do no harm; a cache that can't be read or written only costs time.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import llvmlite
import llvmlite.binding as llvm
from llvmlite import ir

__all__ = ["Compiled", "lanes", "processor"]

_DIGEST: Final = hashlib.sha256().digest_size


@lru_cache(maxsize=1)
def processor() -> tuple[str, str]:
    """The processor's name and features, as LLVM calls them."""
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def lanes() -> int:
    """Doubles in a vector register of this processor, but at least 4: LLVM halves vectors that are too wide."""
    return 8 if "+avx512f" in processor()[1].split(",") else 4


class Compiled:
    """A compiled function, and what keeps it in memory."""

    def __init__(self, module: ir.Module, name: str, prototype: Any) -> None:
        """Compile a module.

        Args:
            module: the instructions.
            name: the function's name there.
            prototype: of ctypes, to call it; the interpreter's lock is released meanwhile.
        """
        text = str(module)
        cpu, features = processor()
        triple = llvm.get_default_triple()
        key = hashlib.sha256("\0".join((text, triple, cpu, features, llvmlite.__version__)).encode()).hexdigest()
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        parsed = llvm.parse_assembly(text)
        self._machine = llvm.Target.from_default_triple().create_target_machine(
            cpu=cpu, features=features, opt=3, jit=True
        )
        self._engine = llvm.create_mcjit_compiler(parsed, self._machine)
        found = _load(key)
        if found is None:
            options = llvm.create_pipeline_tuning_options(speed_level=2)
            passes = llvm.create_pass_builder(self._machine, options).getModulePassManager()
            passes.run(parsed, llvm.create_pass_builder(self._machine, options))
        self._engine.set_object_cache(lambda _, code: _store(key, code), lambda _: found)
        self._engine.finalize_object()
        self.call = prototype(self._engine.get_function_address(name))


def _folder() -> Path:
    """Where compiled code is kept: ``$PINSCREW_CACHE``, or the user's cache folder."""
    given = os.environ.get("PINSCREW_CACHE")
    if given:
        return Path(given)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "pinscrew"


def _load(key: str) -> bytes | None:
    """What was compiled before, if it is whole."""
    try:
        content = (_folder() / key).read_bytes()
    except (OSError, RuntimeError):  # RuntimeError: there is no home
        return None
    digest, code = content[:_DIGEST], content[_DIGEST:]
    return code if hashlib.sha256(code).digest() == digest else None


def _store(key: str, code: bytes) -> None:
    with contextlib.suppress(OSError, RuntimeError):
        folder = _folder()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(hashlib.sha256(code).digest() + code)
            Path(name).replace(folder / key)
        except OSError:
            Path(name).unlink(missing_ok=True)
            raise
