"""Sign, and check signatures, with Ed25519; the only module that needs the package cryptography."""

from __future__ import annotations

from typing import Any

from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives.asymmetric.ed25519 import (
    Ed25519PrivateKey,
    Ed25519PublicKey,
)
from cryptography.hazmat.primitives.serialization import (
    load_pem_private_key,
    load_pem_public_key,
    load_ssh_private_key,
    load_ssh_public_key,
)

PrivateKey = Ed25519PrivateKey
PublicKey = Ed25519PublicKey


def is_signed(key: bytes, signature: bytes, text: bytes) -> bool:
    """Return whether a public key's owner has signed a text; False if it is not a key."""
    try:
        PublicKey.from_public_bytes(key).verify(signature, text)
    except (InvalidSignature, ValueError):
        return False
    return True


def read_key(data: bytes, kind: type[PrivateKey] | type[PublicKey]) -> Any:
    """Return the key in a file: PEM, or the format of OpenSSH; not encrypted.

    Raises:
        ValueError: the file holds no such key; the text says why.
    """
    try:
        if kind is PublicKey:
            pem = data.lstrip().startswith(b"-----")
            key: object = load_pem_public_key(data) if pem else load_ssh_public_key(data)
        elif b"BEGIN OPENSSH" in data:
            key = load_ssh_private_key(data, None)
        else:
            key = load_pem_private_key(data, None)
    except (TypeError, UnsupportedAlgorithm, ValueError) as error:
        raise ValueError(str(error)) from error
    if not isinstance(key, kind):
        raise ValueError("it is a key of another kind")
    return key
