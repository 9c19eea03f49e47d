"""The wheel: what it exports, and that its stub says the same."""

import orbflow_native


def test_a_raised_token_stays_raised() -> None:
    token = orbflow_native.CancelToken()
    assert not token.is_cancelled
    token.cancel()
    assert token.is_cancelled
