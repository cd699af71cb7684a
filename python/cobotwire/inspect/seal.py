"""Seal documents: a digest of the contents, and a signature if there is a key.

The digest is the SHA-256 of the document without its keys ``digest`` and ``signature``, as JSON in
one line: keys sorted, no spaces, ASCII only, numbers as Python writes them. The signature is that
of Ed25519 over the text ``NAME sha256 DIGEST``, where NAME is the document's ``format``.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, NamedTuple

from cobotwire.protocol.errors import UsageError

SEAL = ("digest", "signature")
ALGORITHM = "ed25519"
# A key file is a few hundred bytes.
LONGEST_KEY = 64_000

# Returns the signature of a text, with the public key.
Signer = Callable[[str], dict[str, str]]


class Seal(NamedTuple):
    """What the seal of a document shows.

    ``digest`` is computed from the contents, and ``stated`` is in the document. ``key`` is the
    public key that signed it, in hex; empty: it is not signed.
    """

    digest: str
    stated: str
    signature: Literal["none", "right", "wrong"]
    key: str = ""

    @property
    def intact(self) -> bool:
        """Whether the contents are those that were sealed."""
        return self.digest == self.stated and self.signature != "wrong"


def digest_of(document: Mapping[str, Any]) -> str:
    """Return the digest of a document, in hex."""
    contents = {name: value for name, value in document.items() if name not in SEAL}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    return sha256(text.encode()).hexdigest()


def sealed(document: Mapping[str, Any], sign: Signer | None = None) -> dict[str, Any]:
    """Return a document with its digest, and with a signature if there is a signer."""
    digest = digest_of(document)
    found = {**document, "digest": digest}
    if sign is not None:
        found["signature"] = sign(_signed_text(document, digest))
    return found


def check_seal(document: Mapping[str, Any]) -> Seal:
    """Return what the seal of a document shows.

    Raises:
        UsageError: it is signed, and cryptography is not installed.
    """
    digest, stated = digest_of(document), document.get("digest")
    found = Seal(digest, stated if isinstance(stated, str) else "", "none")
    signature = document.get("signature")
    if signature is None:
        return found
    try:
        key, value = (bytes.fromhex(signature[name]) for name in ("public_key", "value"))
        known = signature["algorithm"] == ALGORITHM
    except (LookupError, TypeError, ValueError):
        return found._replace(signature="wrong")
    signed = _signed_text(document, digest).encode(errors="replace")
    right = known and _library().is_signed(key, value, signed)
    return found._replace(signature="right" if right else "wrong", key=key.hex())


def _signed_text(document: Mapping[str, Any], digest: str) -> str:
    return f"{document.get('format')} sha256 {digest}"


def load_signer(path: str) -> Signer:
    """Return the signer with the private key of a file: Ed25519, as PEM or in OpenSSH's format.

    Raises:
        UsageError: the file holds no such key, or cryptography is not installed.
    """
    key = _load(path, _library().PrivateKey, "sign")
    public = key.public_key().public_bytes_raw().hex()
    return lambda text: {
        "algorithm": ALGORITHM,
        "public_key": public,
        "value": key.sign(text.encode()).hex(),
    }


def load_public_key(path: str) -> str:
    """Return the public key of a file in hex: PEM, or a line of OpenSSH.

    Raises:
        UsageError: as :func:`load_signer`.
    """
    found: str = _load(path, _library().PublicKey, "key").public_bytes_raw().hex()
    return found


def _load(path: str, kind: type, argument: str) -> Any:
    try:
        with Path(path).open("rb") as file:
            return _library().read_key(file.read(LONGEST_KEY), kind)
    except OSError as error:
        raise UsageError(argument, message=f"{path}: {error.strerror}") from None
    except ValueError as error:
        which = "private" if argument == "sign" else "public"
        message = (
            f"{path} is not an Ed25519 {which} key in PEM or OpenSSH format without a "
            f"passphrase: {error}"
        )
        raise UsageError(argument, message=message) from None


def _library() -> ModuleType:
    try:
        from cobotwire.inspect import ed25519
    except ImportError as error:
        message = "signatures need cryptography: pip install 'cobotwire[sign]'"
        raise UsageError("cryptography", message=message) from error
    return ed25519
