"""`python -m bem` is `bem`."""

from bem.cli import main

if __name__ == "__main__":
    main()
