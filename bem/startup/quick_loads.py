"""Compiled loops of this package, read from disk without readying the compiler, which most runs never need.

Numba readies it at the first loop that it loads: all that it knows of arrays, lists and texts (fifty modules), other
packages' extensions, its own memory routines compiled again, and for each loop the intermediate code, in case that
another loop takes it in. Together an eighth of a second contact. Here this waits until something has to be compiled.
Files that were cut off (a full disk) are left, and their loops compiled anew; numba ends in an error there.

Knows numba's inside, nothing of ours. Verified in tests/packaging/test_quick_loads.py: nothing of it is loaded by a
run whose loops are there; a loop compiled later still takes in what was loaded like this; a numba made differently is
left as it is. Tried with numba 0.60, 0.64 and 0.68.
"""

from __future__ import annotations

import importlib
import sys
from typing import Any

_OURS = __name__.partition(".")[0] + "."
_LATER = "_intermediate_code"
_ONLY_WHEN_READY = b"_numba_hashsecret"
"""Begins the names that compiled code finds only once numba's hashes are loaded; it would end the process."""
_OF_LOADING = {"refresh", "_guard_against_spurious_io_errors", "_load_overload"}
_OF_READING = {
    *("create_library", "isinstance", "ll", "parse_bitcode", "_final_module", "_finalize_final_module", "ValueError"),
    *("enable_object_caching", "_set_compiled_object", "_shared_module", "_codegen", "_engine"),
    *("_load_defined_symbols", "AssertionError"),
}
_OF_MEMORY = {
    *("_init", "config", "NRT_STATS", "_nrt", "memsys_enable_stats", "c_helpers", "startswith", "ll", "add_symbol"),
    *("nrtdynmod", "compile_nrt_functions", "_library"),
}
"""What numba's functions that are replaced or not waited for speak of. One that speaks of more does more than is done
here."""


def quicken() -> None:
    """Load loops of this package like this from now on in this process; nothing where numba is made differently."""
    try:
        from numba.core import caching, codegen
        from numba.core.runtime.nrt import rtsys

        cache: Any = caching.FunctionCache
        library: Any = codegen.CPUCodeLibrary
        loaded: Any = codegen.JITCodeLibrary
        if hasattr(library, "_read_quickly"):
            return
        helpers = dict(importlib.import_module("numba.core.runtime._nrt_python").c_helpers)
        _ = (cache.load_overload, cache._load_overload, cache._guard_against_spurious_io_errors, rtsys._init)
        _ = (cache.flush, cache.disable, library._get_module_for_linking, loaded.get_pointer_to_function)
        _ = codegen.JitEngine._load_defined_symbols
        memory: Any = type(rtsys).initialize
        as_known = (
            _speaks_of(cache.load_overload) <= _OF_LOADING
            and _speaks_of(library._unserialize.__func__) <= _OF_READING
            and _speaks_of(memory.__wrapped__) <= _OF_MEMORY
        )
    except (ImportError, AttributeError):
        return
    if not as_known:
        return
    _load_before_ready(cache, rtsys, helpers)
    _read_code_alone(library, loaded)
    library._read_quickly = True


def _speaks_of(function: Any) -> set[str]:
    return set(function.__code__.co_names)


def _load_before_ready(cache: Any, memory: Any, helpers: dict[str, int]) -> None:
    """Ready the compiler for what is not on disk only; compiled code finds numba's `helpers` for memory without it."""
    import llvmlite.binding as llvm

    usual = cache.load_overload

    def with_registries(self: Any, signature: Any, context: Any) -> Any:
        _load_registries()
        return usual(self, signature, context)

    def load_overload(self: Any, signature: Any, context: Any) -> Any:
        if not str(self._py_func.__module__).startswith(_OURS):
            return with_registries(self, signature, context)
        if not memory._init:
            for name, address in helpers.items():
                llvm.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)
            helpers.clear()
        found = None
        try:
            with self._guard_against_spurious_io_errors():
                found = self._load_overload(signature, context)
        except Exception:  # pickle raises anything over a file that was cut off
            _forget(self)
        return with_registries(self, signature, context) if found is None else found

    cache.load_overload = load_overload


def _forget(cache: Any) -> None:
    """Let what a cache holds of a function be compiled and written anew, or compiled only where that fails."""
    try:
        cache.flush()
    except OSError:
        cache.disable()


def _read_code_alone(library: Any, loaded: Any) -> None:
    """Leave the intermediate code of what is read unread until another loop takes it in."""
    import llvmlite.binding as llvm

    usual, usual_module, usual_pointer = (
        library._unserialize.__func__,
        library._get_module_for_linking,
        loaded.get_pointer_to_function,
    )

    def read(cls: Any, generator: Any, state: tuple[str, str, Any]) -> Any:
        name, kind, content = state
        if kind != "object":
            return usual(cls, generator, state)
        if _ONLY_WHEN_READY in content[0]:
            importlib.import_module("numba.cpython.hashing")
        made = generator.create_library(name)
        made.enable_object_caching()
        made._set_compiled_object(content[0])
        setattr(made, _LATER, content[1])
        made._finalize_final_module()
        return made

    def module_for_linking(self: Any) -> Any:
        code = self.__dict__.pop(_LATER, None)
        if code is not None:
            self._shared_module = llvm.parse_bitcode(code)
            self._codegen._engine._load_defined_symbols(self._shared_module)
        return usual_module(self)

    def pointer(self: Any, name: str) -> Any:
        if name.encode() in self.__dict__.get(_LATER, b""):
            self._codegen._engine._defined_symbols.add(name)
        elif _LATER in self.__dict__:
            self._get_module_for_linking()  # a pointer to nothing would end the process
        return usual_pointer(self, name)

    library._unserialize = classmethod(read)
    library._get_module_for_linking = module_for_linking
    loaded.get_pointer_to_function = pointer


def _load_registries() -> None:
    """Load what numba knows of arrays without the linear algebra that it looks for on the way, which brings all of
    `scipy.linalg` and f2py along: a tenth of a second. A compiled function that multiplies matrices looks for it
    again, and finds it."""
    if "numba.np.arraymath" in sys.modules:
        return
    import numba.np.linalg

    looks = numba.np.linalg.ensure_blas
    numba.np.linalg.ensure_blas = lambda: None
    try:
        import numba.np.arraymath

        assert numba.np.arraymath
    finally:
        numba.np.linalg.ensure_blas = looks
