"""From a module of instructions to a function to call: compiled for this processor, and kept on disk.

What was compiled is found again by the instructions themselves, the system, the processor, the compiler's version and
ours, so a later process loads it in milliseconds (see `pinscrew.engines.compiled.cache`).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm
from llvmlite import ir

from pinscrew.engines.compiled import cache
from pinscrew.ground.version import __version__

__all__ = ["Compiled", "lanes", "processor"]


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
        key = cache.key_of(text, triple, cpu, features, llvmlite.__version__, __version__)
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        parsed = llvm.parse_assembly(text)
        self._machine = llvm.Target.from_default_triple().create_target_machine(
            cpu=cpu, features=features, opt=3, jit=True
        )
        self._engine = llvm.create_mcjit_compiler(parsed, self._machine)
        kept = cache.load(key)
        if kept is None:
            options = llvm.create_pipeline_tuning_options(speed_level=2)
            passes = llvm.create_pass_builder(self._machine, options).getModulePassManager()
            passes.run(parsed, llvm.create_pass_builder(self._machine, options))
        self._engine.set_object_cache(lambda _, code: cache.store(key, code), lambda _: kept)
        self._engine.finalize_object()
        self.call = prototype(self._engine.get_function_address(name))
